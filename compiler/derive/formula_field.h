// Fields made of formulas. The proved bound on a formula's slope within a box (compiler/derive/formula_bound.h) makes
// the formula a field like any other. Outside the box the field is the distance from the box, joined at a right angle
// (compiler/shapes/domain.cpp, "meet"), so the solid ends at the box. A formula without a bound becomes an estimate.
// Tested by: tests/compiler/derive/formula_field_test.cpp
#pragma once

#include "compiler/derive/formula_bound.h"
#include "compiler/shapes/make_node.h"

namespace fathom::compiler {

// Like NodeMaker::make(), for every kind of node that scenes have. Expression and Displacement become Bounded nodes
// with proved numbers. The child of an Expression is the formula. The children of a Displacement are the displaced
// node and the formula. `allowance` is the scene's.
NodeId make_field(NodeMaker& maker, Kind kind, Params params, std::span<const NodeId> children,
                  const SourceLocation& origin, SearchAllowance& allowance);

// Proof of a Bounded node's Lipschitz constant.
enum class FormulaProof {
  None,     // the constant is a guess, and no cell of the box has a bound
  Proved,   // the constant holds in the whole box
  InCells,  // the constant is a guess, but cells of the box have bounds (compiler/analysis/formula_cells.h)
  Steep,    // the constant holds in the whole box, but is much larger than the usual slope near the surface
};
constexpr bool holds_everywhere(FormulaProof proof) {
  return proof == FormulaProof::Proved || proof == FormulaProof::Steep;
}
FormulaProof proof_of(const Graph& graph, NodeId bounded);

// Makes a formula the field of a box with any corners.
NodeId make_bounded(NodeMaker& maker, NodeId formula, const Box& box, const SourceLocation& origin,
                    SearchAllowance& allowance);

}  // namespace fathom::compiler
