#include "compiler/graph.h"

#include <fmt/format.h>

#include <bit>

#include "compiler/shapes/node_table.h"
#include "vm/check.h"

namespace fathom::compiler {
namespace {

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

std::string print_params(Kind kind, std::span<const double> params) {
  if (kind == Kind::Transform && params.size() == 13) {
    return fmt::format(" rows=[{}] factor={}", fmt::join(params.first(12), ","), params[12]);
  }
  if (kind == Kind::Paint && params.size() == 1) return fmt::format(" surface={}", params[0]);
  if (kind == Kind::Scaled && params.size() == 1) return fmt::format(" factor={}", params[0]);
  std::string out;
  std::size_t at = 0;
  for (const ParamSpec& param : spec(kind).params) {
    const bool rest = param.type == ParamType::Points;
    const std::size_t count = rest ? params.size() - at : static_cast<std::size_t>(width(param.type));
    if (count == 0) continue;
    if (at + count > params.size()) break;
    if (count == 1) {
      out += fmt::format(" {}={}", param.name, params[at]);
    } else {
      out += fmt::format(" {}=[{}]", param.name, fmt::join(params.subspan(at, count), ","));
    }
    at += count;
  }
  if (at < params.size()) out += fmt::format(" derived=[{}]", fmt::join(params.subspan(at), ","));
  return out;
}

std::string print_origin(const Origin& origin, const Source& source) {
  std::string out;
  if (!origin.name.empty()) out += fmt::format(" \"{}\"", origin.name);
  if (origin.span.end > 0) {
    const Position at = source.locate(origin.span.begin);
    out += fmt::format(" {}:{}:{}", source.name(), at.line, at.column);
  }
  return out.empty() ? out : ";" + out;
}

}  // namespace

NodeId Graph::add(Kind kind, std::span<const double> params, std::span<const NodeId> children, const Origin& origin) {
  // Copies: the spans may point into this graph, whose storage is about to move. Adding 0.0 turns -0.0 into 0.0.
  std::vector<double> own_params(params.begin(), params.end());
  for (double& param : own_params) param += 0.0;
  const std::vector<NodeId> own_children(children.begin(), children.end());
  for (const NodeId child : own_children) CHECK(child < nodes_.size(), "a child is made before its parent");

  const std::uint64_t hash = hash_of(kind, own_params, own_children);
  const auto [first, last] = by_hash_.equal_range(hash);
  for (auto it = first; it != last; ++it) {
    if (equal(it->second, kind, own_params, own_children)) return it->second;
  }
  const auto id = static_cast<NodeId>(nodes_.size());
  nodes_.push_back({kind, static_cast<std::uint32_t>(params_.size()), static_cast<std::uint32_t>(own_params.size()),
                    static_cast<std::uint32_t>(children_.size()), static_cast<std::uint32_t>(own_children.size()),
                    origin});
  params_.insert(params_.end(), own_params.begin(), own_params.end());
  children_.insert(children_.end(), own_children.begin(), own_children.end());
  by_hash_.emplace(hash, id);
  return id;
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
    // By bits, so that a NaN equals itself.
    if (std::bit_cast<std::uint64_t>(params_[node.first_param + i]) != std::bit_cast<std::uint64_t>(params[i])) {
      return false;
    }
  }
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (children_[node.first_child + i] != children[i]) return false;
  }
  return true;
}

std::string print_graph(const Scene& scene, const Source& source) {
  constexpr std::size_t kCommentColumn = 36;
  const Graph& graph = scene.graph;
  if (graph.size() == 0) return "";
  std::vector<bool> reached(scene.root + 1, false);
  reached[scene.root] = true;
  for (NodeId id = scene.root + 1; id-- > 0;) {
    if (!reached[id]) continue;
    for (const NodeId child : graph.children(id)) reached[child] = true;
  }
  std::vector<NodeId> number(scene.root + 1, 0);
  NodeId next = 0;
  std::string out;
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (!reached[id]) continue;
    number[id] = next++;
    std::string line = fmt::format("%{} = {}{}", number[id], spec(graph.kind(id)).name,
                                   print_params(graph.kind(id), graph.params(id)));
    for (const NodeId child : graph.children(id)) line += fmt::format(" %{}", number[child]);
    const std::string origin = print_origin(graph.origin(id), source);
    if (!origin.empty())
      line = fmt::format("{:<{}}{}{}", line, kCommentColumn, line.size() < kCommentColumn ? "" : " ", origin);
    out += line + "\n";
  }
  return out;
}

}  // namespace fathom::compiler
