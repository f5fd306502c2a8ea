#include "compiler/graph/graph.h"

#include <algorithm>
#include <bit>

#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

constexpr NodeId kFree = 0xffffffff;  // marks a free entry of the table

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  // The finaliser of splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
  std::uint64_t z = (hash ^ word) + 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

std::uint64_t hash_of(Kind kind, std::span<const double> params, std::span<const NodeId> children) {
  std::uint64_t hash = static_cast<std::uint64_t>(kind);
  for (const double param : params) hash = mixed(hash, std::bit_cast<std::uint64_t>(param));
  hash = mixed(hash, params.size());
  for (const NodeId child : children) hash = mixed(hash, child);
  return hash;
}

}  // namespace

NodeId Graph::add(Kind kind, std::span<const double> params, std::span<const NodeId> children,
                  const SourceLocation& origin) {
  // Copies the spans, which may point into this graph, because the graph's storage is about to move. Adding 0.0 turns
  // -0.0 into 0.0.
  new_params_.assign(params.begin(), params.end());
  for (double& param : new_params_) param += 0.0;
  new_children_.assign(children.begin(), children.end());
  for (const NodeId child : new_children_) CHECK(child < nodes_.size(), "a child is made before its parent");

  if (table_.size() < 2 * (nodes_.size() + 1)) grow_table();
  const std::uint64_t hash = hash_of(kind, new_params_, new_children_);
  std::size_t place = hash & (table_.size() - 1);
  for (; table_[place] != kFree; place = (place + 1) & (table_.size() - 1)) {
    const NodeId id = table_[place];
    if (nodes_[id].hash == hash && equal(id, kind, new_params_, new_children_)) return id;
  }
  const auto id = static_cast<NodeId>(nodes_.size());
  nodes_.push_back({kind, static_cast<std::uint32_t>(params_.size()), static_cast<std::uint32_t>(new_params_.size()),
                    static_cast<std::uint32_t>(children_.size()), static_cast<std::uint32_t>(new_children_.size()),
                    hash, origin});
  params_.insert(params_.end(), new_params_.begin(), new_params_.end());
  children_.insert(children_.end(), new_children_.begin(), new_children_.end());
  table_[place] = id;
  return id;
}

void Graph::grow_table() {
  table_.assign(std::max<std::size_t>(64, 2 * table_.size()), kFree);
  for (NodeId id = 0; id < nodes_.size(); ++id) {
    std::size_t place = nodes_[id].hash & (table_.size() - 1);
    while (table_[place] != kFree) place = (place + 1) & (table_.size() - 1);
    table_[place] = id;
  }
}

std::span<const double> Graph::params(NodeId id) const {
  return std::span(params_).subspan(nodes_[id].first_param, nodes_[id].param_count);
}

std::span<const NodeId> Graph::children(NodeId id) const {
  return std::span(children_).subspan(nodes_[id].first_child, nodes_[id].child_count);
}

bool Graph::equal(NodeId id, Kind kind, std::span<const double> params, std::span<const NodeId> children) const {
  const Node& node = nodes_[id];
  if (node.kind != kind || node.param_count != params.size() || node.child_count != children.size()) return false;
  for (std::size_t i = 0; i < params.size(); ++i) {
    // Compares bits, so that a NaN equals itself.
    if (std::bit_cast<std::uint64_t>(params_[node.first_param + i]) != std::bit_cast<std::uint64_t>(params[i])) {
      return false;
    }
  }
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (children_[node.first_child + i] != children[i]) return false;
  }
  return true;
}

}  // namespace fathom::compiler
