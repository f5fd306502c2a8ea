#include <algorithm>
#include <array>
#include <variant>

#include "compiler/bounds.h"
#include "compiler/lower.h"
#include "compiler/passes/passes.h"
#include "compiler/passes/signs.h"
#include "vm/evaluate.h"
#include "vm/verify.h"

namespace fathom::compiler {
namespace {

// Pairs of operands are compared in lists up to this long; longer ones are left to the renderer.
constexpr std::size_t kLongestList = 512;
// Operands with more instructions than this are not run to see whether they hold another.
constexpr std::size_t kLongestProgram = 256;

class Culling {
 public:
  explicit Culling(const Scene& scene) : scene_(scene), free_(only_sign_counts(scene)) {}

  NodeId make(Graph& out, NodeId id, const std::vector<NodeId>& children) {
    const Kind kind = scene_.graph.kind(id);
    std::vector<NodeId> kept = children;
    if (free_[id] && children.size() > 1 && children.size() <= kLongestList) {
      if (kind == Kind::Union) kept = without_hidden(out, children);
      if (kind == Kind::Subtraction) kept = without_idle_cuts(out, children);
      if (kind == Kind::Intersection) kept = without_idle_limits(out, children);
    }
    if (kept.size() == 1 && children.size() > 1) return kept[0];
    return out.add(kind, scene_.graph.params(id), kept, scene_.graph.origin(id));
  }

 private:
  // Arms of a union that lie wholly inside another do not show.
  std::vector<NodeId> without_hidden(const Graph& graph, const std::vector<NodeId>& arms) {
    std::vector<NodeId> kept;
    for (std::size_t i = 0; i < arms.size(); ++i) {
      const Box& box = known(graph, arms[i]).box;
      const auto hides = [&](NodeId other) { return other != arms[i] && holds(graph, other, box); };
      if (std::none_of(arms.begin(), arms.end(), hides)) kept.push_back(arms[i]);
    }
    return kept.empty() ? arms : kept;
  }

  // Cuts that do not reach what is left.
  std::vector<NodeId> without_idle_cuts(const Graph& graph, const std::vector<NodeId>& operands) {
    const Box base = known(graph, operands[0]).box;
    std::vector<NodeId> kept = {operands[0]};
    for (std::size_t i = 1; i < operands.size(); ++i) {
      if (!intersect(base, known(graph, operands[i]).box).empty()) kept.push_back(operands[i]);
    }
    return kept;
  }

  // Operands of an intersection that hold all the others' box cut nothing off.
  std::vector<NodeId> without_idle_limits(const Graph& graph, const std::vector<NodeId>& operands) {
    std::vector<NodeId> kept = operands;
    for (std::size_t i = 0; i < kept.size() && kept.size() > 1;) {
      Box others = Box::everything();
      for (std::size_t j = 0; j < kept.size(); ++j) {
        if (j != i) others = intersect(others, known(graph, kept[j]).box);
      }
      if (!others.empty() && holds(graph, kept[i], others)) {
        kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    return kept;
  }

  // Whether the solid's inside contains the whole box; false when that is not seen at one look.
  bool holds(const Graph& graph, NodeId solid, const Box& box) {
    const Box& own = known(graph, solid).box;
    if (box.empty() || !box.finite() || !own.contains(box.lo) || !own.contains(box.hi)) return false;
    const std::optional<vm::Program> program = lower(graph, solid, Source("", ""), kLongestProgram);
    if (!program) return false;
    auto verified = vm::verify(*program);
    if (!std::holds_alternative<vm::VerifiedProgram>(verified)) return false;
    return vm::evaluate_range(std::get<vm::VerifiedProgram>(verified), box.lo, box.hi, workspace_).hi < 0;
  }

  const Knowledge& known(const Graph& graph, NodeId id) {
    while (known_.size() <= id) known_.push_back(know(graph, static_cast<NodeId>(known_.size()), known_));
    return known_[id];
  }

  const Scene& scene_;
  const std::vector<bool> free_;
  std::vector<Knowledge> known_;  // [node] of the graph that is made
  vm::Workspace workspace_;
};

}  // namespace

Scene cull(const Scene& scene) {
  Culling culling(scene);
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    return culling.make(out, id, children);
  });
}

}  // namespace fathom::compiler
