// Fields made of formulas: the proved bound on a formula's slope within a box (compiler/derive/formula_bound.h) makes it a
// field like any other. Outside the box the field is the box's distance, met at a right angle
// (compiler/shapes/domain.cpp, "meet"): the solid ends there. A formula without a bound becomes an estimate.
// Tested by: tests/compiler/derive/formula_field_test.cpp
#pragma once

#include "compiler/shapes/make_node.h"

namespace fathom::compiler {

// NodeMaker::make() for every kind of node that scenes have. Expression and Displacement become Bounded nodes with
// proved numbers. Children of an Expression: the formula; of a Displacement: the displaced node and the formula.
NodeId make_field(NodeMaker& maker, Kind kind, Params params, std::span<const NodeId> children, const Origin& origin);

// A formula as the field of a box with any corners.
NodeId make_bounded(NodeMaker& maker, NodeId formula, const Box& box, const Origin& origin);

}  // namespace fathom::compiler
