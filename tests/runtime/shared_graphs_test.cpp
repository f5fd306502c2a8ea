// Small scenes in which a node is used in so many ways that a walk over the graph as over a tree would never end.
// Forty doublings took 2^39 visits to find lamps, lamps within other bodies, bodies of two materials, and what is
// bounded beside a plane. That each verb ends is tested, not how soon: the system ends the program after seconds of a
// processor that no machine is slow enough to need.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <string>

#include "tests/support/program.h"

namespace fathom::shared_graphs_test {

namespace {

using namespace fathom::tests;

// `doubled`: a node in which $ stands for the one before, forty times.
std::string doublings(const std::string& base, const std::string& doubled) {
  std::string nodes = R"("n0": )" + base;
  for (int i = 1; i <= 40; ++i) {
    const std::string use = fmt::format(R"({{"use": "n{}"}})", i - 1);
    std::string node = doubled;
    for (std::size_t at; (at = node.find("$")) != node.npos;) node.replace(at, 1, use);
    nodes += fmt::format(R"(, "n{}": {})", i, node);
  }
  return R"({"version": 1, "film": {"width": 4, "height": 4}, "render": {"spp": 1}, "materials": {
      "lamp": {"type": "emissive", "emission": [1, 1, 1]}, "clay": {"type": "diffuse"},
      "glass": {"type": "transparent"}, "water": {"type": "transparent"}}, "nodes": {)" +
         nodes + R"(}, "objects": [{"use": "n40"}, {"type": "sphere", "radius": 9, "material": "clay"}]})";
}

const char* const kVerbs[] = {"check scene.json",
                              "dump scene.json --diff",
                              "dump scene.json --stage graph --format json",
                              "dump scene.json --stage bytecode",
                              "eval scene.json --at 1,2,3",
                              "emit cpp scene.json",
                              "render -q scene.json -o scene.png"};

void check_all(const std::string& scene) {
  const Folder folder;
  folder.write("scene.json", scene);
  const std::string seconds = is_sanitized() ? "300" : "30";
  for (const std::string verb : kVerbs) {
    const Result result = folder.run_script("ulimit -t " + seconds + "\n\"$fathom\" " + verb);
    INFO(verb << "\n" << scene.substr(0, 600) << "\n" << result.err.substr(0, 600));
    CHECK(result.code == 0);
  }
}

TEST_CASE("shared graphs: every verb visits a node that is used in many ways once", "[limits]") {
  const std::string ball = R"({"type": "sphere", "radius": 1, "material": "lamp"})";
  check_all(doublings(ball, R"({"type": "union", "of": [$, $]})"));
  check_all(doublings(R"({"type": "union", "of": [{"type": "sphere", "radius": 1, "material": "glass"},
      {"type": "sphere", "radius": 2, "material": "water"}]})",
                      R"({"type": "union", "of": [$, $]})"));
  check_all(doublings(R"({"type": "union", "of": [{"type": "plane", "normal": [0, 1, 0], "offset": -9},
      {"type": "sphere", "radius": 1}]})",
                      R"({"type": "smooth_union", "k": 0.001, "of": [$, $]})"));
}

}  // namespace

}  // namespace fathom::shared_graphs_test
