// The passes over the DAG. One pass = one file = one function = one name for `fathom dump --after`.
// Each leaves the field as it was, but for rounding in double; level and cull leave its sign, and its being a
// distance. Tested by: tests/compiler/passes/passes_test.cpp
#pragma once

#include <span>
#include <string_view>

#include "compiler/graph/graph.h"

namespace fathom::compiler {

struct Pass {
  std::string_view name;
  Scene (*run)(const Scene&);
  enum class Leaves { Field, Sign } leaves = Leaves::Field;  // what of the scene stays as it was
};

// What is done to the distance, in order. The surface program keeps its Paint and takes the others.
std::span<const Pass> passes();

// Divides the operands of unions, intersections and cuts by their Lipschitz constants where these differ, so that the
// steep one of them slows no ray down but its own. Only where the sign of the value is all that counts: below an
// offset or a blend the values are left as they are.
Scene level(const Scene& scene);

// Removes Paint: what the distance alone needs.
Scene unpaint(const Scene& scene);

// Computes what constants decide: offsets of 0 or of offsets, blends of width 0, combinators of one node, the
// transform that changes nothing, the offset of a sphere, the complement of a complement, factors of factors.
Scene fold(const Scene& scene);

// Computes functions of constants and leaves out what changes no number: a + 0, 1 * a, -(-a), a + -b, (-a)^2.
Scene arithmetic(const Scene& scene);

// Multiplies nested transforms into one.
Scene affine(const Scene& scene);

// Merges unions of unions, intersections of intersections, and subtractions whose base is a subtraction. Never smooth
// ones: their result depends on the order.
Scene flatten(const Scene& scene);

// Leaves out what changes no sign: arms of a union wholly inside another, cuts that do not reach what they cut,
// limits that hold all they limit. Distances further away may grow; they stay distances.
Scene cull(const Scene& scene);

// Puts the operands of unions, intersections and cuts in one order and drops repeated ones, so that equal nodes
// become one node, which is evaluated once. Likewise of sums, products, minima and maxima of numbers.
Scene share(const Scene& scene);

}  // namespace fathom::compiler
