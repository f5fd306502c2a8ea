#include "compiler/graph.h"

#include <fmt/format.h>

#include <bit>

#include "compiler/passes/rewrite.h"
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
  std::string out;
  for (const NamedParam& param : named_params(kind, params)) {
    const bool list = param.values.size() > 1;
    out += fmt::format(" {}={}{}{}", param.name, list ? "[" : "", fmt::join(param.values, ","), list ? "]" : "");
  }
  return out;
}

// `place`: whether to say where in the source, too.
std::string print_origin(const Origin& origin, const Source& source, bool place) {
  std::string out;
  if (!origin.name.empty()) out += fmt::format(" \"{}\"", origin.name);
  if (place && origin.span.end > 0) {
    const Position at = source.locate(origin.span.begin);
    out += fmt::format(" {}:{}:{}", source.name(), at.line, at.column);
  }
  return out.empty() ? out : ";" + out;
}

// Names by place, made distinct in the order of asking.
class PlaceNames {
 public:
  explicit PlaceNames(const Source& source) : source_(source) {}

  std::string name(Kind kind, const Origin& origin) {
    std::string name(spec(kind).name);
    if (origin.span.end > 0) {
      const Position at = source_.locate(origin.span.begin);
      name += fmt::format("@{}:{}", at.line, at.column);
    }
    const int count = ++counts_[name];
    return count == 1 ? name : fmt::format("{}.{}", name, count);
  }

 private:
  const Source& source_;
  std::unordered_map<std::string, int> counts_;
};

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

std::vector<NamedParam> named_params(Kind kind, std::span<const double> params) {
  if (kind == Kind::Transform && params.size() == 13) {
    return {{"rows", params.first(12)}, {"factor", params.last(1)}};
  }
  if (kind == Kind::Paint && params.size() == 1) return {{"surface", params}};
  if (kind == Kind::Scaled && params.size() == 1) return {{"factor", params}};
  std::vector<NamedParam> named;
  std::size_t at = 0;
  for (const ParamSpec& param : spec(kind).params) {
    const bool rest = param.type == ParamType::Points;
    const std::size_t count = rest ? params.size() - at : static_cast<std::size_t>(width(param.type));
    if (count == 0) continue;
    if (at + count > params.size()) break;
    named.push_back({param.name, params.subspan(at, count)});
    at += count;
  }
  if (at < params.size()) named.push_back({"derived", params.subspan(at)});
  return named;
}

std::string print_graph(const Scene& scene, const Source& source, NodeNames names) {
  constexpr std::size_t kCommentColumn = 36;
  const Graph& graph = scene.graph;
  if (graph.size() == 0) return "";
  const std::vector<bool> reached = reachable(scene);
  PlaceNames places(source);
  std::vector<std::string> called(scene.root + 1);
  std::size_t next = 0;
  std::string out;
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (!reached[id]) continue;
    const Kind kind = graph.kind(id);
    const bool numbers = names == NodeNames::Numbers;
    called[id] = numbers ? fmt::format("{}", next++) : places.name(kind, graph.origin(id));
    std::string line = fmt::format("%{} = {}{}", called[id], spec(kind).name, print_params(kind, graph.params(id)));
    for (const NodeId child : graph.children(id)) line += fmt::format(" %{}", called[child]);
    const std::string origin = print_origin(graph.origin(id), source, numbers);
    if (!origin.empty())
      line = fmt::format("{:<{}}{}{}", line, kCommentColumn, line.size() < kCommentColumn ? "" : " ", origin);
    out += line + "\n";
  }
  return out;
}

}  // namespace fathom::compiler
