#include "vm/native/register_file.h"

#include <algorithm>

#include "vm/program/check.h"

namespace fathom::vm {
namespace {

constexpr std::uint32_t kNoNode = 0xffffffff;

}  // namespace

std::vector<std::uint32_t> RegisterFile::reads_of(const OperationGraph& graph, std::uint32_t at) {
  std::vector<std::uint32_t> reads;
  if (at == graph.nodes.size()) return graph.results;
  const OperationNode& node = graph.nodes[at];
  if (node.is_mask()) return reads;  // a mask is computed where it is used
  for (std::size_t o = 0; o < node.count(); ++o) {
    const OperationNode& operand = graph.nodes[node.operands[o]];
    if (!operand.is_mask()) {
      reads.push_back(node.operands[o]);
    } else {
      for (std::size_t i = 0; i < operand.count(); ++i) reads.push_back(operand.operands[i]);
    }
  }
  return reads;
}

RegisterFile::RegisterFile(const OperationGraph& graph, int registers)
    : values_(graph.nodes.size()), holders_(static_cast<std::size_t>(registers), kNoNode) {
  for (int reg = registers; reg-- > 0;) free_registers_.push_back(reg);
  for (std::uint32_t i = 0; i < graph.nodes.size(); ++i) {
    values_[i].in_memory = graph.nodes[i].kind != OperationNode::Kind::Operation;
  }
  for (auto at = static_cast<std::uint32_t>(graph.nodes.size() + 1); at-- > 0;) {
    for (const std::uint32_t node : reads_of(graph, at)) values_[node].uses.push_back(at);
  }
}

RegisterFile::Taken RegisterFile::take(std::uint32_t node, const std::vector<std::uint32_t>& pinned) {
  Taken taken{};
  if (free_registers_.empty()) {
    std::uint32_t victim = kNoNode;
    const auto distance = [&](std::uint32_t holder) {
      const Value& value = values_[holder];
      return std::pair(value.uses.back(), value.in_memory || value.slot != kNone);
    };
    for (const std::uint32_t holder : holders_) {
      if (std::find(pinned.begin(), pinned.end(), holder) != pinned.end()) continue;
      if (victim == kNoNode || distance(holder) > distance(victim)) victim = holder;
    }
    CHECK(victim != kNoNode, "an operation has fewer operands than there are registers");
    Value& value = values_[victim];
    if (!value.in_memory && value.slot == kNone) {
      if (free_slots_.empty()) free_slots_.push_back(slots_++);
      value.slot = free_slots_.back();
      free_slots_.pop_back();
      taken.spills = true, taken.spilled_reg = value.reg, taken.slot = value.slot;
    }
    free_registers_.push_back(value.reg);
    value.reg = kNone;
  }
  taken.reg = free_registers_.back();
  free_registers_.pop_back();
  holders_[static_cast<std::size_t>(taken.reg)] = node;
  values_[node].reg = taken.reg;
  return taken;
}

void RegisterFile::end_uses(const std::vector<std::uint32_t>& nodes, std::uint32_t at) {
  free_slots_.insert(free_slots_.end(), released_slots_.begin(), released_slots_.end());
  released_slots_.clear();
  for (const std::uint32_t node : nodes) {
    Value& value = values_[node];
    while (!value.uses.empty() && value.uses.back() <= at) value.uses.pop_back();
    if (!value.uses.empty()) continue;
    if (value.reg != kNone) {
      holders_[static_cast<std::size_t>(value.reg)] = kNoNode;
      free_registers_.push_back(value.reg);
    }
    if (value.slot != kNone) released_slots_.push_back(value.slot);
    value.reg = value.slot = kNone;
  }
}

}  // namespace fathom::vm
