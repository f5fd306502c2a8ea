// End-to-end tests of `fathom dump` and `fathom schema`.
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_dump_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

}  // namespace

TEST_CASE("cli: schema is JSON on stdout", "[cli]") {
  const Result result = Folder().run("schema");
  CHECK(result.code == 0);
  CHECK(result.err == "");
  const auto schema = nlohmann::json::parse(result.out);
  CHECK(schema["$schema"] == "https://json-schema.org/draft/2020-12/schema");
  CHECK(schema["required"] == nlohmann::json({"version", "objects"}));
}

TEST_CASE("cli: dump prints each stage on stdout", "[cli]") {
  const Folder folder;
  CHECK_THAT(folder.run("dump ball.json").out, Contains("sphere") && Contains("0.5"));
  CHECK_THAT(folder.run("dump two.json --program surface").out, Contains("tag"));
  CHECK_THAT(folder.run("dump two.json --program distance").out, !Contains("tag"));
  CHECK_THAT(folder.run("dump ball.json --stage syntax").out, Contains("radius"));
  CHECK_THAT(folder.run("dump ball.json --stage graph").out, Contains("%0 = sphere radius=0.5"));
  CHECK_THAT(folder.run("dump two.json --after graph").out, Contains("%0 = ") && Contains("union"));
  CHECK_THAT(folder.run("dump two.json --after graph --stage bytecode").out, Contains("box"));
  CHECK_THAT(folder.run("dump two.json --stats").out, Contains("sphere") && Contains("total"));
  CHECK(folder.run("dump two.json").err == "");
}

TEST_CASE("cli: dump prints JSON and drawings", "[cli]") {
  const Folder folder;
  const auto program = nlohmann::json::parse(folder.run("dump two.json --program surface --format json").out);
  CHECK(program["program"] == "surface");
  CHECK(program["code"].size() == program["instructions"]);
  std::size_t cost = 0, end = 0;
  for (const auto& line : program["code"]) {
    CHECK(line["offset"] == end);
    cost += line["cost"].get<std::size_t>();
    end += 1 + line["immediates"].size() + (line.contains("at") ? 3 : 0);
    CHECK(line.contains("operand") == (line["op"] == "tag"));
  }
  CHECK(program["cost"] == cost);
  CHECK(program["words"] == end);
  CHECK(program["code"].back()["values"] == nlohmann::json({2, 1}));
  const auto graph = nlohmann::json::parse(folder.run("dump two.json --stage graph --format json").out);
  CHECK(graph["nodes"].size() == 5);  // sphere, box, their transforms, union
  const auto first = nlohmann::json::parse(folder.run("dump two.json --after graph --format json").out);
  CHECK(first["nodes"].size() == 7);  // and two paints
  CHECK_THAT(folder.run("dump two.json --format dot").out, Contains("digraph scene {") && Contains("n4 -> n1;"));
  CHECK_THAT(folder.run("dump two.json --format mermaid").out, Contains("flowchart TD") && Contains("n4 -->|1| n1"));
}

// Regression: the dump left out all but the first immediates group of an outline, and all later offsets were wrong.
TEST_CASE("cli: dump prints every group of an outline as JSON, and what is fused", "[cli]") {
  const Folder folder;
  folder.write("triangle.json", R"({"version": 1, "objects": [
    {"type": "extrude", "half_depth": 1, "of": {"type": "polygon", "points": [[0, 0], [2, 0], [0, 1]]}},
    {"type": "sphere", "radius": 1, "translate": [0, 5, 0]}]})");
  const auto program = nlohmann::json::parse(folder.run("dump triangle.json --format json").out);
  CHECK(program["code"].size() == 4);  // polygon, slab, meet, the translated sphere with a fused min
  const auto& polygon = program["code"][0];
  CHECK(polygon["op"] == "polygon");
  CHECK(polygon["operand"] == 3);
  CHECK(polygon["immediates"] == nlohmann::json::parse(R"([{"x": 0, "y": 0}, {"x": 2, "y": 0}, {"x": 0, "y": 1}])"));
  CHECK(program["code"][1]["offset"] == 7);
  const auto& sphere = program["code"][3];
  CHECK(sphere["at"] == nlohmann::json({0, 5, 0}));
  CHECK(sphere["min"] == true);
  CHECK(sphere["immediates"] == nlohmann::json({{"radius", 1}}));
}

TEST_CASE("cli: dump --diff prints what each pass changed and saved", "[cli]") {
  const Folder folder;
  folder.write("fold.json", R"({"version": 1, "objects": [
    {"type": "round", "radius": 0.25, "of": {"type": "sphere", "radius": 1}},
    {"type": "box", "half_size": [1, 1, 1]}]})");
  const Result result = folder.run("dump fold.json --diff");
  CHECK(result.code == 0);
  CHECK(result.out ==
        R"(; pass strip: 6 -> 4 nodes, 6 -> 4 ops, cost 24 -> 24
--- graph
+++ strip
@@ -1,6 +1,4 @@
 %sphere@2:45 = sphere radius=1
 %round@2:5 = round radius=0.25 %sphere@2:45
-%paint@2:5 = paint surface=0 %round@2:5
 %box@3:5 = box half_size=[1,1,1]
-%paint@3:5 = paint surface=1 %box@3:5
-%union = union %paint@2:5 %paint@3:5
+%union = union %round@2:5 %box@3:5
; pass fold: 4 -> 3 nodes, 4 -> 3 ops, cost 24 -> 23
--- strip
+++ fold
@@ -1,4 +1,3 @@
-%sphere@2:45 = sphere radius=1
-%round@2:5 = round radius=0.25 %sphere@2:45
+%sphere@2:5 = sphere radius=1.25
 %box@3:5 = box half_size=[1,1,1]
-%union = union %round@2:5 %box@3:5
+%union = union %sphere@2:5 %box@3:5
; pass fuse: 3 -> 3 nodes, 3 -> 2 ops, cost 23 -> 23
)");
  CHECK(folder.run("dump fold.json --diff --after graph").out == "; no pass changed anything\n");
  CHECK_THAT(folder.run("dump fold.json --diff --after strip").out, !Contains("pass fold"));
}

TEST_CASE("cli: dump --region prints the part that matters at a point, and the whole program", "[cli]") {
  const Folder folder;
  std::string row;
  for (int i = 0; i < 60; ++i) {
    row += (i > 0 ? ", " : "") + std::string("{\"type\": \"sphere\", \"name\": \"at ") + std::to_string(i) +
           "\", \"radius\": 0.2" + std::to_string(i) + ", \"translate\": [" + std::to_string(i) + ", 0, 0]}";
  }
  folder.write("row.json", "{\"version\": 1, \"objects\": [" + row + "]}");
  const auto near = folder.run("dump row.json --region 3.2,0.1,0");
  CHECK(near.code == 0);
  const std::size_t whole = near.out.find("; whole: ");
  CHECK_THAT(near.out, Contains("; region at 3.2 0.1 0: program, cell ["));
  CHECK_THAT(near.out, Contains("; the whole program is so short that renders evaluate it everywhere"));
  CHECK(near.out.find("sphere \"at 3\"") < whole);
  CHECK(near.out.find("sphere \"at 50\"") > whole);
  CHECK_THAT(folder.run("dump row.json --region 3.5,0.5,0").out,
             Contains(": far, cell") || Contains(": program, cell"));
  CHECK(folder.run("dump two.json --region 0.9,0,0 --stats").code == 2);
  CHECK(folder.run("dump two.json --region 0.9,0,0 --stage graph").code == 2);
  CHECK(folder.run("dump two.json --region here").code == 2);
}

TEST_CASE("cli: dump --stats says what operations and nodes cost, the dearest first", "[cli]") {
  CHECK(Folder().run("dump two.json --stats").out ==
        R"(operation             count      cost   share
box                       1        16   64.0%
sphere                    1         9   36.0%
total                     2        25

5 nodes of the graph

place    ops      cost   share  node
6:5        1        16   64.0%  box "right"
5:5        1         9   36.0%  sphere "left"
total      2        25
)");
}

TEST_CASE("cli: dump --run shows the stacks at a point and names the first number that is not finite", "[cli]") {
  const Folder folder;
  const auto ball = folder.run("dump ball.json --run --at 0,3,0");
  CHECK(ball.code == 0);
  CHECK_THAT(ball.out, Contains("; at 0 3 0\n") && Contains("\n;   points (0 3 0)   values 2.5\n"));
  CHECK(ball.out.find("not finite") == std::string::npos);
  // The output is still a valid listing, because the stacks are in comments.
  CHECK(folder.run("asm - -o run.fbc", ball.out).code == 0);
  CHECK(folder.run("dump run.fbc --run --at 0,3,0").out.find("values 2.5") != std::string::npos);
  REQUIRE(folder.run("asm - -o nan.fbc", "x\nsqrt\nsphere 1 min\n").code == 0);
  const auto bad = folder.run("dump nan.fbc --run --at=-1,0,0");
  CHECK_THAT(bad.out, Contains("; the first number that is not finite, nan, is left by 0001"));
  CHECK(folder.run("dump ball.json --run").code == 2);
  CHECK(folder.run("dump ball.json --at 0,0,0").code == 2);
  CHECK(folder.run("dump ball.json --run --at 0,0,0 --stats").code == 2);
  std::string lines = "sphere 1\n";
  for (int i = 0; i < 20000; ++i) lines += "sphere 1 min\n";
  REQUIRE(folder.run("asm - -o long.fbc", lines).code == 0);
  const auto refused = folder.run("dump long.fbc --run --at 0,0,0");
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Contains("too long to be run once for each of its instructions"));
}

// Regression: the diff printed pages of operands in another order, which saves nothing.
TEST_CASE("cli: dump --diff leaves out operands that only change places", "[cli]") {
  const Folder folder;
  folder.write("swap.json", R"_({"version": 1, "objects": [
    {"type": "expression", "formula": ["a = sin(x)", "b = cos(y)", "min(b, a) + b*a"]}]})_");
  CHECK_THAT(folder.run("dump swap.json --diff").out, !Contains("pass share"));
}

TEST_CASE("cli: dump --diff of two scenes says what their programs differ in", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile two.json -o two.fbc").code == 0);
  CHECK(folder.run("dump --diff two.json two.fbc").out == "; two.json and two.fbc are the same program\n");
  const auto diff = folder.run("dump --diff ball.json two.fbc");
  CHECK(diff.code == 0);
  CHECK_THAT(diff.out, Contains("; 1 -> 2 ops, 2 -> 12 words, cost 8 -> 25\n--- ball.json\n+++ two.fbc\n@@") &&
                           Contains("\n-sphere 0.5") && Contains("\n+sphere 1 at -2 0 0"));
  REQUIRE(folder.run("compile --strip two.json -o bare.fbc").code == 0);
  CHECK(folder.run("dump --diff two.fbc bare.fbc").out == "; two.fbc and bare.fbc are the same program\n");
  CHECK(folder.run("dump --diff two.json two.fbc --program surface").out ==
        "; two.json and two.fbc are the same program\n");
  CHECK(folder.run("dump two.json two.fbc").code == 2);
  CHECK(folder.run("dump --diff two.json two.fbc --stage graph").code == 2);
  CHECK(folder.run("dump --diff two.json none.fbc").code == 74);
}

}  // namespace fathom::cli_dump_test
