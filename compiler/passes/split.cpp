#include "compiler/passes/split.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "compiler/geometry/box_tree.h"
#include "compiler/graph/rewrite.h"
#include "compiler/passes/closed_forms.h"
#include "compiler/passes/signs.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

// Costs besides a piece's program, in multiply-adds of each evaluation (bench/pieces.cpp): of a step of the marcher;
// of a ray's start and end in a piece; of a look at a few pieces, and of each form there; of the tree of many.
constexpr double kStepCost = 300, kStartCost = 380, kScanCost = 220, kFormCost = 18, kTreeCost = 300;
// Maximum number of pieces that rays look at without a tree (runtime/march/closed_form.h).
constexpr std::size_t kFewPieces = 32;

// Half of the surface of a box.
double half_area(const Box& box) {
  if (box.empty()) return 0;
  const glm::dvec3 d = box.hi - box.lo;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

double cost_of(std::span<const Instruction> instructions) {
  double cost = 0;
  for (const Instruction& each : instructions)
    cost += static_cast<double>(vm::instruction_cost(vm::opcode_word(each.opcode, each.operand)));
  return cost;
}

class Splitting {
 public:
  explicit Splitting(const Scene& scene) : scene_(scene), free_(only_sign_counts(scene)) {
    for (const bool reached : reachable(scene)) most_ += 4 * static_cast<std::size_t>(reached);
  }

  Pieces run() {
    const std::vector<bool> reached = reachable(scene_);
    whole_.resize(scene_.root + 1);
    arms_.resize(scene_.root + 1);
    for (NodeId id = 0; id <= scene_.root; ++id) {
      if (reached[id]) visit(id);
    }
    std::vector<NodeId> pieces = std::move(arms_[scene_.root]);
    if (!is_worth(pieces, true)) pieces = {whole_[scene_.root]};
    return {std::move(out_), std::move(pieces)};
  }

 private:
  void visit(NodeId id) {
    std::vector<NodeId> children;
    for (const NodeId child : scene_.graph.children(id)) children.push_back(whole_[child]);
    whole_[id] = add(id, children);
    arms_[id] = arms_of(id, children);
    if (arms_[id].empty()) arms_[id] = {whole_[id]};
  }

  // Returns the arms that the node divides into, or none if it stays one piece.
  std::vector<NodeId> arms_of(NodeId id, const std::vector<NodeId>& children) {
    const std::span<const NodeId> operands = scene_.graph.children(id);
    switch (scene_.graph.kind(id)) {
      case Kind::Union: {
        std::vector<NodeId> arms;
        for (const NodeId operand : operands) arms.insert(arms.end(), arms_[operand].begin(), arms_[operand].end());
        return is_worth(arms, false) ? arms : std::vector<NodeId>{};
      }
      case Kind::Transform:
      case Kind::Scaled:
      case Kind::Paint:
      case Kind::Round:
      case Kind::Subtraction:
        return distributed(id, children, 0);
      case Kind::Intersection: {
        const auto several =
            std::ranges::find_if(operands, [&](NodeId operand) { return arms_[operand].size() > 1; });
        if (several == operands.end()) return {};
        return distributed(id, children, static_cast<std::size_t>(several - operands.begin()));
      }
      default:
        return {};
    }
  }

  // Returns the node over each arm of its operand number `over`.
  std::vector<NodeId> distributed(NodeId id, std::vector<NodeId> children, std::size_t over) {
    const std::vector<NodeId> inner = arms_[scene_.graph.children(id)[over]];
    if (inner.size() == 1) return {};
    if (scene_.graph.kind(id) == Kind::Subtraction) children = with_arms_of_cuts(id);
    std::vector<NodeId> arms;
    std::size_t copied = 0;
    for (const NodeId arm : inner) {
      children[over] = arm;
      const std::vector<NodeId> operands =
          scene_.graph.kind(id) == Kind::Subtraction && free_[id] ? reaching(children) : children;
      copied += operands.size();
      if (copied_ + copied > most_) return {};
      arms.push_back(operands.size() == 1 && children.size() > 1 ? arm : add(id, operands));
    }
    copied_ += copied;
    return arms;
  }

  // Returns a subtraction's operands, each cut divided: a - (b | c) = a - b - c.
  std::vector<NodeId> with_arms_of_cuts(NodeId id) const {
    std::vector<NodeId> operands;
    for (const NodeId operand : scene_.graph.children(id)) {
      const std::vector<NodeId>& arms = arms_[operand];
      if (operands.empty()) {
        operands.push_back(whole_[operand]);
      } else {
        operands.insert(operands.end(), arms.begin(), arms.end());
      }
    }
    return operands;
  }

  // Returns a subtraction's operands without the cuts that do not reach the box of the first.
  std::vector<NodeId> reaching(const std::vector<NodeId>& operands) const {
    std::vector<NodeId> kept = {operands[0]};
    std::copy_if(operands.begin() + 1, operands.end(), std::back_inserter(kept),
                 [&](NodeId cut) { return !apart(facts_[operands[0]].box, facts_[cut].box); });
    return kept;
  }

  // True if rays are faster among the arms than in their union. `all`: the arms are the whole scene. Arms with a
  // proved bound leave those without: their rays keep the proof.
  bool is_worth(std::span<const NodeId> arms, bool all) const {
    if (arms.size() < 2) return true;
    const auto rough = std::ranges::count_if(arms, [this](NodeId arm) { return is_rough(arm); });
    if (rough > 0 && rough < std::ssize(arms)) return true;
    Box around;
    for (const NodeId arm : arms) {
      if (facts_[arm].box.finite()) around = unite(around, facts_[arm].box);
    }
    const bool few = arms.size() <= kFewPieces;
    double apart = !all ? 0 : few ? kScanCost : kTreeCost, together = kStepCost;
    for (const NodeId arm : arms) {
      const Box& box = facts_[arm].box;
      const double share = box.finite() ? half_area(box) / std::max(half_area(around), 1e-300) : 1;
      const std::size_t forms = few ? closed_forms(out_, arm).size() : 0;
      const double marched = cost_[arm] + kStepCost + (all && few ? kStartCost : 0);
      apart += forms > 0 ? kFormCost * static_cast<double>(forms) : std::min(1.0, share) * marched;
      together += cost_[arm];
    }
    return apart < together;
  }

  // True if nothing is proved of the node, or if it was made flatter for its neighbours' sake (passes/normalise), whose
  // roots are then known no better than its own.
  bool is_rough(NodeId id) const {
    constexpr double kSteep = 4;
    if (!facts_[id].certified) return true;
    while (out_.kind(id) == Kind::Paint) id = out_.children(id)[0];
    return out_.kind(id) == Kind::Scaled && facts_[out_.children(id)[0]].lipschitz > kSteep;
  }

  // Adds a node like number `id` over these children.
  NodeId add(NodeId id, const std::vector<NodeId>& children) {
    const Kind kind = scene_.graph.kind(id);
    const NodeId node = out_.add(kind, scene_.graph.params(id), children, scene_.graph.origin(id));
    if (node < facts_.size()) return node;
    facts_.push_back(derive_facts(out_, node, facts_));
    const Code code = spec(kind).code(scene_.graph.params(id));
    double cost = cost_of(code.after);
    for (const auto& chain : code.points) {
      cost += cost_of(chain);
      for (const NodeId child : children) cost += cost_[child];
    }
    cost_.push_back(cost);
    return node;
  }

  const Scene& scene_;
  const std::vector<bool> free_;
  std::size_t most_ = 0, copied_ = 0;  // nodes that may be, and that are, copied over arms
  Graph out_;
  std::vector<NodeFacts> facts_;           // [node of out_]
  std::vector<double> cost_;               // [node of out_] of the program, multiply-adds, as if nothing was shared
  std::vector<NodeId> whole_;              // [node] the same node of out_
  std::vector<std::vector<NodeId>> arms_;  // [node] nodes of out_ whose union is the node
};

}  // namespace

Pieces split(const Scene& scene) { return Splitting(scene).run(); }

bool is_convex(const Graph& graph, NodeId id) {
  const auto children = graph.children(id);
  switch (graph.kind(id)) {
    case Kind::Transform:
    case Kind::Scaled:
    case Kind::Paint:
    case Kind::Round:
      return is_convex(graph, children[0]);
    case Kind::Intersection:
      return std::ranges::all_of(children, [&](NodeId child) { return is_convex(graph, child); });
    default: {
      if (spec(graph.kind(id)).category != Category::Primitive) return false;
      const Code code = spec(graph.kind(id)).code(graph.params(id));
      return code.after.size() == 1 && code.points.size() == 1 && code.points[0].empty() &&
             has(vm::info(code.after[0].opcode).facts, vm::Fact::Convex);
    }
  }
}

}  // namespace fathom::compiler
