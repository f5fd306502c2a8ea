// Formulas as distances: a bound on how fast a formula changes within a box, proved by interval arithmetic on its
// derivative, makes it a field like any other. Outside the box the field is the box's distance, met at a right angle
// (compiler/shapes/domain.cpp, "meet"): the solid ends there.
//
// The bound is that of cells the box is cut into, the steepest first, until it is within a few percent of a slope
// that does occur. A formula that jumps has none, and becomes an estimate. Source: Moore, "Interval Analysis", 1966.
// Tested by: tests/compiler/formula_field_test.cpp
#pragma once

#include "compiler/make_node.h"

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

// Rows of the node table (Kind::Expression, Kind::Displacement). Parameters: the box's half size; none. Children: the
// formula; the displaced node and the formula.
NodeId build_expression(NodeMaker& maker, Params params, std::span<const NodeId> children, const Origin& origin);
NodeId build_displacement(NodeMaker& maker, Params params, std::span<const NodeId> children, const Origin& origin);

// A formula as the field of a box with any corners.
NodeId make_bounded(NodeMaker& maker, NodeId formula, const Box& box, const Origin& origin);

}  // namespace fathom::compiler
