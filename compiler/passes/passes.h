// The passes over the DAG. One pass = one file = one function = one name for `fathom dump --after`.
// Each leaves the field as it was, but for rounding in double.
// Tested by: tests/compiler/passes_test.cpp
#pragma once

#include "compiler/graph.h"

namespace fathom::compiler {

// Removes Paint: what the distance alone needs.
Scene unpaint(const Scene& scene);

// Computes what constants decide: offsets of 0 or of offsets, blends of width 0, combinators of one node, the
// transform that changes nothing, the offset of a sphere.
Scene fold(const Scene& scene);

// Multiplies nested transforms into one.
Scene affine(const Scene& scene);

// Merges unions of unions, intersections of intersections, and subtractions whose base is a subtraction. Never smooth
// ones: their result depends on the order.
Scene flatten(const Scene& scene);

// Puts the operands of unions, intersections and cuts in one order and drops repeated ones, so that equal nodes
// become one node, which is evaluated once.
Scene share(const Scene& scene);

}  // namespace fathom::compiler
