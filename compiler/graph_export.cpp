#include "compiler/graph_export.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compiler/graph/rewrite.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"
#include "compiler/shapes/print_graph.h"

namespace fathom::compiler {
namespace {

using GraphJson = nlohmann::ordered_json;

// The nodes that the root reaches, numbered from 0, children first.
struct NumberedNode {
  std::vector<NodeId> ids;             // [number]
  std::vector<std::size_t> number_of;  // [id]
};

NumberedNode number_nodes(const Scene& scene) {
  NumberedNode out{{}, std::vector<std::size_t>(scene.graph.size(), 0)};
  const std::vector<bool> reached = reachable(scene);
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (!reached[id]) continue;
    out.number_of[id] = out.ids.size();
    out.ids.push_back(id);
  }
  return out;
}

std::string_view word(Exactness exactness) {
  constexpr std::string_view kWords[] = {"exact", "bound", "estimate"};
  return kWords[static_cast<std::size_t>(exactness)];
}

GraphJson finite_or_null(double number) { return std::isfinite(number) ? GraphJson(number) : GraphJson(nullptr); }

GraphJson to_json(glm::dvec3 v) {
  return GraphJson::array({finite_or_null(v.x), finite_or_null(v.y), finite_or_null(v.z)});
}

GraphJson to_json(const Box& box) {
  if (box.empty()) return nullptr;
  return {{"lo", to_json(box.lo)}, {"hi", to_json(box.hi)}};
}

GraphJson params_json(const Graph& graph, NodeId id) {
  GraphJson params = GraphJson::object();
  for (const NamedParam& param : named_params(graph.kind(id), graph.params(id))) {
    GraphJson& value = params[std::string(param.name)];
    if (param.values.size() == 1) {
      value = finite_or_null(param.values[0]);
    } else {
      for (const double number : param.values) value.push_back(finite_or_null(number));
    }
  }
  return params;
}

GraphJson source_json(const SourceLocation& origin, const Source& source) {
  if (origin.span.end == 0) return nullptr;
  const Position at = source.locate(origin.span.begin);
  GraphJson json = {{"line", at.line}, {"column", at.column}};
  if (const Source& file = source.file(origin.span.begin); &file != &source) json["file"] = file.name();
  return json;
}

GraphJson node_json(const Graph& graph, NodeId id, const NumberedNode& nodes, const NodeFacts& known,
                    const Source& source) {
  GraphJson children = GraphJson::array();
  for (const NodeId child : graph.children(id)) children.push_back(nodes.number_of[child]);
  return {{"id", nodes.number_of[id]},        {"type", spec(graph.kind(id)).name},
          {"params", params_json(graph, id)}, {"children", children},
          {"name", graph.origin(id).name},    {"source", source_json(graph.origin(id), source)},
          {"box", to_json(known.box)},        {"lipschitz", finite_or_null(known.lipschitz)},
          {"outside", word(known.outside)},   {"inside", word(known.inside)},
          {"certified", known.certified}};
}

// Prints the JSON. A file's name may be invalid UTF-8, which JSON does not allow, so invalid bytes are replaced.
std::string print(const GraphJson& json) { return json.dump(-1, ' ', false, GraphJson::error_handler_t::replace); }

// Returns the lines of a node's label: its type and name, its parameters, its place in the source.
std::vector<std::string> label(const Graph& graph, NodeId id, const Source& source) {
  const SourceLocation& origin = graph.origin(id);
  std::vector<std::string> lines = {std::string(spec(graph.kind(id)).name)};
  if (!origin.name.empty()) lines[0] += fmt::format(" \"{}\"", origin.name);
  for (const NamedParam& param : named_params(graph.kind(id), graph.params(id))) {
    std::string numbers;
    for (const double number : param.values) numbers += fmt::format(" {:.6g}", number);
    lines.push_back(fmt::format("{}{}", param.name, numbers));
  }
  if (origin.span.end > 0)
    lines.push_back(
        fmt::format("line {}{}", source.locate(origin.span.begin).line, source.in_import(origin.span.begin)));
  return lines;
}

// Replaces some characters of `text`. Names have no control characters, because the reader refuses them.
template <typename Replace>
std::string escape(const std::string& text, const Replace& replace) {
  std::string out;
  for (const char c : text) {
    const std::string_view other = replace(c);
    out += other.empty() ? std::string_view(&c, 1) : other;
  }
  return out;
}

std::string escape_dot(const std::string& text) {
  return escape(text, [](char c) { return c == '"' ? "\\\"" : c == '\\' ? "\\\\" : ""; });
}

// Source: Mermaid's documentation, "Flowcharts: entity codes to escape characters".
std::string escape_mermaid(const std::string& text) {
  return escape(text, [](char c) {
    return c == '"' ? "#quot;" : c == '#' ? "#35;" : c == '<' ? "#lt;" : c == '>' ? "#gt;" : c == '`' ? "#96;" : "";
  });
}

}  // namespace

std::string graph_json(const Scene& scene, const Source& source) {
  const NumberedNode nodes = number_nodes(scene);
  const std::vector<NodeFacts> known = analyse(scene.graph);
  std::string out =
      fmt::format("{{\"scene\":{},\"root\":{},\"nodes\":[", print(source.name()), nodes.number_of[scene.root]);
  for (const NodeId id : nodes.ids) {
    out += fmt::format("{}{}", id == nodes.ids[0] ? "\n" : ",\n",
                       print(node_json(scene.graph, id, nodes, known[id], source)));
  }
  return out + "\n]}\n";
}

std::string graph_dot(const Scene& scene, const Source& source) {
  const NumberedNode nodes = number_nodes(scene);
  std::string out = "digraph scene {\n  node [shape=box];\n  graph [ordering=out];\n";
  for (const NodeId id : nodes.ids) {
    std::string text;
    for (const std::string& line : label(scene.graph, id, source))
      text += (text.empty() ? "" : "\\n") + escape_dot(line);
    out += fmt::format("  n{} [label=\"{}\"];\n", nodes.number_of[id], text);
  }
  for (const NodeId id : nodes.ids) {
    for (const NodeId child : scene.graph.children(id)) {
      out += fmt::format("  n{} -> n{};\n", nodes.number_of[id], nodes.number_of[child]);
    }
  }
  return out + "}\n";
}

std::string graph_mermaid(const Scene& scene, const Source& source) {
  const NumberedNode nodes = number_nodes(scene);
  std::string out = "flowchart TD\n";
  for (const NodeId id : nodes.ids) {
    std::string text;
    for (const std::string& line : label(scene.graph, id, source)) {
      text += (text.empty() ? "" : "<br>") + escape_mermaid(line);
    }
    out += fmt::format("  n{}[\"{}\"]\n", nodes.number_of[id], text);
  }
  for (const NodeId id : nodes.ids) {
    const auto children = scene.graph.children(id);
    for (std::size_t i = 0; i < children.size(); ++i) {
      const std::string order = children.size() > 1 ? fmt::format("|{}|", i + 1) : "";
      out += fmt::format("  n{} -->{} n{}\n", nodes.number_of[id], order, nodes.number_of[children[i]]);
    }
  }
  return out;
}

}  // namespace fathom::compiler
