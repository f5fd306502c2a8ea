#include "compiler/passes/containment.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "compiler/lower/lower.h"
#include "compiler/shapes/bounds.h"
#include "compiler/source/limits.h"
#include "vm/program/verify.h"

namespace fathom::compiler {
namespace {

// Maximum instructions of an operand that is evaluated to see if it contains another operand.
constexpr std::size_t kLongestProgram = 256;

}  // namespace

std::vector<Containment::Redundancy> Containment::hidden_arms(const Graph& graph, std::span<const NodeId> arms) {
  std::vector<Redundancy> hidden;
  for (const NodeId arm : arms) {
    const Box box = known(graph, arm).box;
    const auto hides = [&](NodeId other) { return other != arm && holds(graph, other, box); };
    const auto within = std::find_if(arms.begin(), arms.end(), hides);
    if (within != arms.end()) hidden.push_back({arm, *within});
  }
  return hidden;
}

std::vector<NodeId> Containment::idle_cuts(const Graph& graph, std::span<const NodeId> operands) {
  const Box base = known(graph, operands[0]).box;
  std::vector<NodeId> idle;
  for (const NodeId cut : operands.subspan(1)) {
    if (intersect(base, known(graph, cut).box).empty()) idle.push_back(cut);
  }
  return idle;
}

std::vector<NodeId> Containment::without_idle_limits(const Graph& graph, std::span<const NodeId> operands) {
  std::vector<NodeId> kept(operands.begin(), operands.end());
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

bool Containment::holds(const Graph& graph, NodeId solid, const Box& box) {
  const Box& own = known(graph, solid).box;
  if (box.empty() || !box.finite() || !own.contains(box.lo) || !own.contains(box.hi)) return false;
  const std::optional<vm::Range> values = range(graph, solid, box);
  return values && values->hi < 0;
}

bool Containment::avoids(const Graph& graph, NodeId solid, const Box& box) {
  const Box common = intersect(known(graph, solid).box, box);
  if (common.empty()) return true;
  if (!common.finite()) return false;
  const std::optional<vm::Range> values = range(graph, solid, common);
  return values && values->lo > 0;
}

std::optional<vm::Range> Containment::range(const Graph& graph, NodeId solid, const Box& box) {
  const auto [found, fresh] = programs_.try_emplace(solid);
  if (fresh) {
    if (std::optional<vm::Program> program = lower(graph, solid, Source("", ""), kLongestProgram)) {
      auto verified = vm::verify(std::move(*program), largest_machine());
      if (auto* sound = std::get_if<vm::VerifiedProgram>(&verified)) found->second = std::move(*sound);
    }
  }
  if (!found->second) return std::nullopt;
  return vm::evaluate_range(*found->second, box.lo, box.hi, workspace_);
}

const NodeFacts& Containment::known(const Graph& graph, NodeId id) {
  while (known_.size() <= id) known_.push_back(derive_facts(graph, static_cast<NodeId>(known_.size()), known_));
  return known_[id];
}

}  // namespace fathom::compiler
