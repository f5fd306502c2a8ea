#include "compiler/derive/formula_field.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compiler/derive/formula_bound.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {
namespace {

constexpr double kInfiniteSide = 1e18;  // replaces an infinite side in the program

double magnitude_of(double float_error) { return std::isfinite(float_error) ? float_error / vm::kFloatError : 0; }

// `at_surface`: the slope near the surface, or 0 if it is not known.
FormulaProof proof_by(const FormulaBound& bound, double at_surface) {
  // Below this ratio, the evaluations that bounds in cells save do not repay them in a short formula.
  constexpr double kSteepRatio = 32;
  if (std::isfinite(bound.lipschitz)) {
    return at_surface > 0 && bound.lipschitz > kSteepRatio * at_surface ? FormulaProof::Steep : FormulaProof::Proved;
  }
  // Cells are of use only if some of them have a bound.
  constexpr double kMaxUnbounded = 0.9;
  return bound.unbounded_share < kMaxUnbounded ? FormulaProof::InCells : FormulaProof::None;
}

NodeId bounded(NodeMaker& maker, NodeId field, const Box& box, double lipschitz, double cancellation,
               FormulaProof proof, const SourceLocation& origin) {
  std::vector<double> params;
  for (const glm::dvec3& corner : {box.lo, box.hi}) {
    for (int i = 0; i < 3; ++i) params.push_back(std::clamp(corner[i], -kInfiniteSide, kInfiniteSide));
  }
  // A field that does not change has its box as its only surface, so any constant will do.
  constexpr double kLeast = 1e-9, kRounding = 1 + 1e-9;
  params.insert(params.end(), {lipschitz > kLeast ? lipschitz * kRounding : 1,
                               holds_everywhere(proof) ? cancellation : 0.0, static_cast<double>(proof)});
  const NodeId children[] = {field};
  return maker.make(Kind::Bounded, params, children, origin);
}

// Estimates the Lipschitz constant of a formula without a proved constant. The slopes that the search has seen next
// to a place of infinite slope say how near the search came.
double estimated(const FormulaBound& bound, double at_surface) {
  constexpr double kMaxSeenRatio = 64;  // of the slope near the surface
  const double seen = at_surface > 0 ? std::min(bound.seen, kMaxSeenRatio * at_surface) : bound.seen;
  return std::max(1.0, 1.5 * seen);
}

struct DisplacedBound {
  Box box;
  FormulaBound formula;  // over the box
};

// Returns a box that contains the displaced solid: the child's box grown by g, where g covers the amount by which the
// formula lowers the distance within the box. The loop extrapolates the needed growth along its slope to where it
// equals the given growth. If the formula always needs more, the solid can be anywhere.
DisplacedBound bound_displaced(const Graph& graph, NodeId formula, const NodeFacts& child,
                               SearchAllowance& allowance) {
  constexpr int kTries = 8;
  double grown = 0, last_grown = 0, last_needed = 0;
  for (int i = 0; i < kTries && child.reach_max > 0 && std::isfinite(grown); ++i) {
    const Box box = child.box.grown(grown);
    const FormulaBound bound = bound_formula(graph, formula, box, allowance);
    const double needed = std::max(0.0, -bound.least) / child.reach_max;
    if (needed <= grown) return {box, bound};
    const double slope = i == 0 ? 0 : (needed - last_needed) / (grown - last_grown);
    last_grown = std::exchange(grown, slope < 0.99 ? (needed - slope * grown) / (1 - slope) : 2 * needed);
    last_needed = needed;
    constexpr double kAbove = 1.0001;  // the bounds are rounded outwards
    grown *= kAbove;
  }
  return {Box::everything(), bound_formula(graph, formula, Box::everything(), allowance)};
}

NodeId displacement(NodeMaker& maker, std::span<const NodeId> children, const SourceLocation& origin,
                    SearchAllowance& allowance) {
  const NodeFacts child = maker.known(children[0]);
  const DisplacedBound found = bound_displaced(maker.graph(), children[1], child, allowance);
  const FormulaBound& bound = found.formula;
  const bool proved = std::isfinite(bound.lipschitz);
  // The slope near the displaced surface is not that of the formula.
  const FormulaProof proof = child.certified ? proof_by(bound, 0) : FormulaProof::None;
  const NodeId sum = maker.make(Kind::Displaced, {}, children, origin);
  return bounded(maker, sum, found.box, child.lipschitz + (proved ? bound.lipschitz : estimated(bound, 0)),
                 child.cancellation + magnitude_of(bound.float_error), proof, origin);
}

}  // namespace

FormulaProof proof_of(const Graph& graph, NodeId bounded) {
  constexpr std::size_t kProof = 8;  // compiler/shapes/functions.cpp
  return static_cast<FormulaProof>(static_cast<int>(graph.params(bounded)[kProof]));
}

NodeId make_bounded(NodeMaker& maker, NodeId formula, const Box& box, const SourceLocation& origin,
                    SearchAllowance& allowance) {
  const FormulaBound bound = bound_formula(maker.graph(), formula, box, allowance);
  const double at_surface = slope_at_surface(maker.graph(), formula, box);
  const bool proved = std::isfinite(bound.lipschitz);
  return bounded(maker, formula, box, proved ? bound.lipschitz : estimated(bound, at_surface),
                 magnitude_of(bound.float_error), proof_by(bound, at_surface), origin);
}

NodeId make_field(NodeMaker& maker, Kind kind, Params params, std::span<const NodeId> children,
                  const SourceLocation& origin, SearchAllowance& allowance) {
  switch (kind) {
    case Kind::Expression:
      return make_bounded(maker, children[0], Box::centred({params[0], params[1], params[2]}), origin, allowance);
    case Kind::Displacement:
      return displacement(maker, children, origin, allowance);
    default:
      return maker.make(kind, params, children, origin);
  }
}

}  // namespace fathom::compiler
