// Golden listings: tests/golden/listings/*.txt hold a scene, its graph after each pass that changed the graph, and
// the listings of both programs.

#include "compiler/compile.h"
#include "compiler/shapes/print_graph.h"
#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/scaled_cases.h"
#include "vm/encoding/disassemble.h"

namespace fathom::listing_test {

namespace {

using namespace fathom;
using namespace fathom::compiler;

std::string print_everything(const std::string& text) {
  const Source source("scene.json", text);
  std::string out, last;
  CompileOptions options;
  options.on_pass = [&](std::string_view pass, const Scene& scene) {
    const std::string graph = print_graph(scene, source);
    if (graph != last) out += "; after " + std::string(pass) + "\n" + graph;
    last = graph;
  };
  Diagnostics diagnostics;
  const auto scene = compile(source, diagnostics, options);
  if (!scene) return diagnostics.print(source, ErrorFormat::Text);
  out += "; distance\n" + vm::disassemble(scene->distance);
  if (scene->surfaces.size() > 1) out += "; surface\n" + vm::disassemble(scene->surface);
  return out + "; " + scene->summary + "\n";
}

}  // namespace

TEST_CASE("golden listings", "[lower][golden]") { test::check_golden("listings", print_everything); }

TEST_CASE("a scene with one surface carries no material code", "[lower]") {
  const Source source("scene.json", R"({"version": 1, "objects": [{"type": "sphere", "radius": 1}]})");
  Diagnostics diagnostics;
  const auto scene = compile(source, diagnostics);
  REQUIRE(scene);
  CHECK(scene->surface.program().words == scene->distance.program().words);
  CHECK(scene->distance.instructions() == 1);
}

// An object of one material is one surface, however many nodes it has and wherever the material is written.
TEST_CASE("an object of one material has no tag in any program, whatever its nodes", "[lower]") {
  const char* const parts = R"([{"type": "sphere", "radius": 1}, {"use": "part", "scale": 2}, {"use": "part"}])";
  const std::string materials = R"("materials": {"red": {"type": "specular"}}, )";
  const std::string nodes = R"("nodes": {"part": {"type": "onion", "thickness": 0.1, "of": {"type": "box",
    "half_size": [1, 1, 1], "translate": [0, 1, 0]}}}, )";
  for (const std::string& object :
       {std::string(R"({"type": "smooth_union", "k": 0.2, "material": "red", "of": )") + parts + "}",
        std::string(
            R"({"type": "union", "material": "red", "of": [{"type": "intersection", "material": "red", "of": )") +
            parts + "}]}"}) {
    const Source source("scene.json", R"({"version": 1, )" + materials + nodes + R"("objects": [)" + object + "]}");
    Diagnostics diagnostics;
    const auto scene = compile(source, diagnostics);
    REQUIRE(scene);
    CHECK(scene->surfaces.size() == 1);
    CHECK(vm::disassemble(scene->distance).find(" tag ") == std::string::npos);
    CHECK(vm::disassemble(scene->surface) == vm::disassemble(scene->distance));
  }
}

TEST_CASE("a thousand nested nodes on either side stay shallow on the stack", "[lower]") {
  for (const bool left : {true, false}) {
    std::string node = R"({"type": "sphere", "radius": 1})";
    const std::string leaf = R"({"type": "box", "half_size": [1, 2, 3]})";
    for (int i = 0; i < 1000; ++i) {
      node = R"({"type": "smooth_union", "k": 0.1, "of": [)" + (left ? node + "," + leaf : leaf + "," + node) + "]}";
    }
    const Source source("scene.json", R"({"version": 1, "objects": [)" + node + "]}");
    Diagnostics diagnostics;
    const auto scene = compile(source, diagnostics);
    REQUIRE(scene);
    CHECK(scene->distance.max_values() == 2);
  }
}

// Regression: a long chain of named nodes overflowed the call stack.
TEST_CASE("a chain of a hundred thousand nodes compiles", "[lower]") {
  const int links = test::scaled_cases(100000);
  std::string nodes = R"("n0": {"type": "sphere", "radius": 1})";
  for (int i = 1; i <= links; ++i) {
    nodes += ",\n \"n" + std::to_string(i) + R"(": {"type": "onion", "thickness": 0.001, "of": {"use": "n)" +
             std::to_string(i - 1) + "\"}}";
  }
  const Source source("scene.json", R"({"version": 1, "nodes": {)" + nodes + R"(}, "objects": [{"use": "n)" +
                                        std::to_string(links) + "\"}]}");
  Diagnostics diagnostics;
  const auto scene = compile(source, diagnostics);
  REQUIRE(scene);
  CHECK(scene->distance.instructions() == static_cast<std::size_t>(links) + 1);
}

}  // namespace fathom::listing_test
