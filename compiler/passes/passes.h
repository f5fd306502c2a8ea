// The passes over the DAG. One pass = one file = one function = one name for `fathom dump --after`.
// Each pass keeps the field except for rounding in double. Normalise and cull keep only the field's sign and the fact
// that the field is a distance. Tested by: tests/compiler/passes/passes_test.cpp
#pragma once

#include <span>
#include <string_view>

#include "compiler/graph/graph.h"

namespace fathom::compiler {

struct Pass {
  std::string_view name;
  Scene (*run)(const Scene&);
  // property of the scene that the pass keeps
  enum class Leaves { Field, Sign } leaves = Leaves::Field;
};

// Returns the passes over the distance graph, in order. The surface program keeps its Paint and takes the other
// passes.
std::span<const Pass> passes();

// Divides the operands of unions, intersections and cuts by their Lipschitz constants if these differ, so that a
// steep operand slows down only its own rays. Applies only where nothing but the value's sign matters: normalise leaves
// the values below an offset or a blend unchanged.
Scene normalise(const Scene& scene);

// Removes Paint, which the distance does not need.
Scene strip(const Scene& scene);

// Simplifies nodes whose parameters make them trivial: offsets of 0 or of offsets, blends of width 0, combinators of
// one node, the identity transform, the offset of a sphere, the complement of a complement, factors of factors.
Scene fold(const Scene& scene);

// Computes functions of constants and removes operations that change no number: a + 0, 1 * a, -(-a), a + -b, (-a)^2.
Scene arithmetic(const Scene& scene);

// Multiplies nested transforms into one.
Scene affine(const Scene& scene);

// Merges unions of unions, intersections of intersections, and subtractions whose base is a subtraction. Never merges
// smooth combinators, whose result depends on the order.
Scene flatten(const Scene& scene);

// Removes operands that change no sign: arms of a union wholly inside another arm, cuts that do not reach the base,
// limits that contain everything they limit. Distances further away may grow, but they stay distances.
Scene cull(const Scene& scene);

// Puts the operands of unions, intersections and cuts in one order and drops repeated ones, so that equal nodes
// become one node, which is evaluated once. Also orders the operands of sums, products, minima and maxima of numbers.
Scene canonicalise(const Scene& scene);

}  // namespace fathom::compiler
