#include "compiler/graph_export.h"

#include <nlohmann/json.hpp>
#include <set>

#include "compiler/compile.h"
#include "compiler/shapes/print_graph.h"
#include "tests/support/catch.h"

namespace fathom::graph_export_test {

namespace {

using namespace fathom::compiler;
using nlohmann::json;

// A ball that is used twice, once cut out of a box; a plane; and a name that needs escaping in every format.
const char* const kText = R"({"version": 1,
  "nodes": {"ball": {"type": "sphere", "radius": 0.5}},
  "objects": [
    {"use": "ball"},
    {"name": "a \"<b>\" \\ #1", "type": "subtraction", "of": [{"type": "box", "half_size": [1, 2, 3]}, {"use": "ball"}]},
    {"type": "plane", "normal": [0, 1, 0], "offset": -3}]})";

struct Optimised {
  Source source{"scene.json", kText};
  Scene scene;
  Optimised() {
    CompileOptions options;
    options.on_pass = [&](std::string_view, const Scene& after) { scene = after; };
    Diagnostics diagnostics;
    REQUIRE(compile(source, diagnostics, options));
  }
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("graph as JSON: each node once, with what is known of it", "[compiler][export]") {
  const Optimised graph;
  const json out = json::parse(graph_json(graph.scene, graph.source));
  CHECK(out["scene"] == "scene.json");
  REQUIRE(out["nodes"].size() == 5);
  CHECK(out["root"] == 4);
  std::size_t id = 0;
  std::set<std::string> types;
  for (const json& node : out["nodes"]) {
    CHECK(node["id"] == id);
    for (const json& child : node["children"]) CHECK(child < id);  // children come first
    types.insert(node["type"].get<std::string>());
    ++id;
  }
  CHECK(types == std::set<std::string>{"sphere", "box", "subtraction", "plane", "union"});
  const json& ball = out["nodes"][0];
  CHECK(ball["params"] == json({{"radius", 0.5}}));
  CHECK(ball["name"] == "ball");
  CHECK(ball["source"] == json({{"line", 2}, {"column", 21}}));
  CHECK(ball["box"] == json({{"lo", {-0.5, -0.5, -0.5}}, {"hi", {0.5, 0.5, 0.5}}}));
  CHECK((ball["lipschitz"] == 1 && ball["outside"] == "exact" && ball["certified"] == true));
  const json& all = out["nodes"][4];
  CHECK(all["type"] == "union");
  CHECK(all["source"] == nullptr);
  CHECK(all["box"]["lo"][0] == nullptr);  // a plane is unbounded
  CHECK(all["children"].size() == 3);
}

TEST_CASE("graph for Graphviz: each node once, an edge for each operand, names escaped", "[compiler][export]") {
  const Optimised graph;
  const std::string out = graph_dot(graph.scene, graph.source);
  CHECK(count(out, " [label=") == 5);
  CHECK(count(out, " -> ") == 5);
  CHECK(count(out, "-> n0;") == 2);  // the ball is shared
  CHECK(out.find(R"([label="subtraction \"a \"<b>\" \\ #1\"\nline 5"];)") != std::string::npos);
}

TEST_CASE("graph for Mermaid: the same, operands numbered", "[compiler][export]") {
  const Optimised graph;
  const std::string out = graph_mermaid(graph.scene, graph.source);
  CHECK(out.starts_with("flowchart TD\n"));
  CHECK(count(out, "[\"") == 5);
  CHECK(count(out, " -->|1| ") == 2);
  CHECK(count(out, " -->|3| ") == 1);
  CHECK(out.find("a #quot;#lt;b#gt;#quot; \\ #35;1#quot;") != std::string::npos);
}

TEST_CASE("a graph printed with names by place keeps them when other nodes go", "[compiler][export]") {
  const Optimised graph;
  const std::string out = print_graph(graph.scene, graph.source, NodeNames::Places);
  CHECK(out.find("%sphere@2:21 = sphere radius=0.5") == 0);
  CHECK(out.find("%union = union ") != std::string::npos);
}

}  // namespace fathom::graph_export_test
