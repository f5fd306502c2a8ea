// Bounds how fast a formula changes within a box, by interval arithmetic on the formula's derivative.
//
// The search bisects the box into cells, the steepest cell first, until the bound is within a few percent of a slope
// that occurs. A formula that jumps has no bound. Source: Moore, "Interval Analysis", 1966.
// Tested by: tests/compiler/derive/formula_field_test.cpp
#pragma once

#include "compiler/geometry/box.h"
#include "compiler/graph/graph.h"

namespace fathom::compiler {

struct FormulaBound {
  double least, most;  // of the values
  double lipschitz;    // of the formula within the box; infinite if the search found no bound
  double seen;         // the steepest gradient that the search evaluated
  double float_error;  // of an evaluation in float, scene units; may be infinite
  double unbounded_share = 0;  // of the box: of the cells without a bound that the search ended with
  Box unbounded = {};          // the smallest cell without a bound that the search met; empty if there is none
};

// Cost that all searches of a scene may still have together, in searches at full length: a tenth of a second each,
// and a second for a very long formula. In a scene with many formulas the searches end earlier and earlier.
struct SearchAllowance {
  double left = 64;
};

// `box` may have infinite sides. `formula` is a node of numbers.
FormulaBound bound_formula(const Graph& graph, NodeId formula, const Box& box, SearchAllowance& allowance);

// Returns the length of the gradient near where the formula is 0: the third quartile at the nearest, by their values
// and slopes, of some points that are spread evenly over the box. 0 in an infinite box.
double slope_at_surface(const Graph& graph, NodeId formula, const Box& box);

// Returns the operation that leaves a formula without a bound: in the smallest cell without a bound, each operand of
// the operation has a bound. In a formula of more than some thousands of operations the result may be one further up.
NodeId find_unbounded(const Graph& graph, NodeId formula, const Box& box);

}  // namespace fathom::compiler
