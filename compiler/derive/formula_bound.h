// A bound on how fast a formula changes within a box, proved by interval arithmetic on its derivative.
//
// The bound is that of cells the box is cut into, the steepest first, until it is within a few percent of a slope
// that does occur. A formula that jumps has none. Source: Moore, "Interval Analysis", 1966.
// Tested by: tests/compiler/derive/formula_field_test.cpp
#pragma once

#include "compiler/geometry/box.h"
#include "compiler/graph/graph.h"

namespace fathom::compiler {

struct FormulaBound {
  double least, most;  // of the values
  double lipschitz;    // of the formula within the box; infinite when none was found
  double seen;         // the steepest gradient met while looking
  double float_error;  // of an evaluation in float, scene units; may be infinite
  Box unbounded = {};  // the smallest cell met for which none was found; empty when there is none
};

// `box` may have infinite sides. `formula` is a node that is a number.
FormulaBound bound_formula(const Graph& graph, NodeId formula, const Box& box);

// The operation that leaves a formula without a bound: in the smallest cell that has none, each of its operands has
// one. Of a formula of more than some thousands of operations it may be one further up.
NodeId find_unbounded(const Graph& graph, NodeId formula, const Box& box);

}  // namespace fathom::compiler
