#include "compiler/shapes/print_graph.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_map>

#include "compiler/graph/rewrite.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

// Returns the number of leading operands whose order matters. The operands after them may come in any order, which a
// pass may change (compiler/passes/canonicalise.cpp).
std::size_t ordered_operands(Kind kind, std::size_t operands) {
  if (spec(kind).commutes || kind == Kind::Union || kind == Kind::Intersection) return 0;
  return kind == Kind::Subtraction ? 1 : operands;
}

// Returns the operands in print order. With names by place, operands whose order does not matter are printed in the
// order of lines, so that two graphs can be compared.
std::vector<NodeId> printed_operands(const Graph& graph, NodeId id, NodeNames names) {
  std::vector<NodeId> operands(graph.children(id).begin(), graph.children(id).end());
  if (names == NodeNames::Numbers) return operands;
  const std::size_t ordered = ordered_operands(graph.kind(id), operands.size());
  std::sort(operands.begin() + static_cast<std::ptrdiff_t>(ordered), operands.end());
  return operands;
}

}  // namespace

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

namespace {

std::string print_params(Kind kind, std::span<const double> params) {
  std::string out;
  for (const NamedParam& param : named_params(kind, params)) {
    const bool list = param.values.size() > 1;
    out += fmt::format(" {}={}{}{}", param.name, list ? "[" : "", fmt::join(param.values, ","), list ? "]" : "");
  }
  return out;
}

// `place`: print the place in the source, too.
std::string print_origin(const SourceLocation& origin, const Source& source, bool place) {
  std::string out;
  if (!origin.name.empty()) out += fmt::format(" \"{}\"", origin.name);
  if (place && origin.span.end > 0) {
    out += ' ' + source.place(origin.span.begin);
  }
  return out.empty() ? out : ";" + out;
}

// Names by place. A number makes equal names distinct, in the order of the calls.
class PlaceNames {
 public:
  explicit PlaceNames(const Source& source) : source_(source) {}

  std::string name(Kind kind, const SourceLocation& origin) {
    std::string name(spec(kind).name);
    if (origin.span.end > 0) {
      const Position at = source_.locate(origin.span.begin);
      name += fmt::format("@{}:{}{}", at.line, at.column, source_.in_import(origin.span.begin));
    }
    const int count = ++counts_[name];
    return count == 1 ? name : fmt::format("{}.{}", name, count);
  }

 private:
  const Source& source_;
  std::unordered_map<std::string, int> counts_;
};

}  // namespace

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
    for (const NodeId child : printed_operands(graph, id, names)) line += fmt::format(" %{}", called[child]);
    const std::string origin = print_origin(graph.origin(id), source, numbers);
    if (!origin.empty())
      line = fmt::format("{:<{}}{}{}", line, kCommentColumn, line.size() < kCommentColumn ? "" : " ", origin);
    out += line + "\n";
  }
  return out;
}

}  // namespace fathom::compiler
