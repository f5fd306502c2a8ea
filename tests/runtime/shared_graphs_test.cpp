// Small scenes that use nodes in so many ways that a walk over the graph as over a tree would never end. Regression:
// forty doublings took 2^39 visits to find lamps, lamps inside other bodies, bodies of two materials, and bounded
// objects next to a plane. The test checks that each verb ends, not how soon: the system kills the program after more
// seconds of processor time than even a slow machine needs.
//
// Random scenes are checked in the same way. Each node uses a few earlier nodes, translated, rotated, scaled or with
// another material, or is an example of docs/reference/gallery.md, which has one of each node type. A verb succeeds
// or refuses the scene with an error.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "compiler/shapes/node_table.h"
#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/program.h"
#include "tests/support/random/random_scene.h"

namespace fathom::shared_graphs_test {

namespace {

using namespace fathom::test;
using test::Random;

// `doubled`: a node in which $ stands for the previous node, applied forty times.
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

// In this order: the verbs after `compile` and `dump --stage file` read the files that these write.
const char* const kVerbs[] = {"check scene.json",
                              "check scene.json --probe 1000 --threads 1",
                              "dump scene.json --diff",
                              "dump scene.json --stage syntax",
                              "dump scene.json --stage graph --format json",
                              "dump scene.json --stage graph --format dot",
                              "dump scene.json --stage graph --format mermaid",
                              "dump scene.json --stage bytecode --stats",
                              "dump scene.json --run --at 1,2,3",
                              "dump scene.json --region 1,2,3",
                              "eval scene.json --at 1,2,3",
                              "eval scene.json --box 0,0,0,1,2,3 --number range",
                              "slice scene.json -o slice.png --size 8x8",
                              "emit cpp scene.json",
                              "emit glsl scene.json",
                              "compile scene.json -o scene.fbc",
                              "check scene.fbc",
                              "dump scene.json --stage file > scene.txt",
                              "asm scene.txt -o again.fbc",
                              "render -q scene.fbc -o scene.png",
                              "render -q scene.json -o scene.film"};

// Not in kVerbs: `chart` marches rays by twenty methods, for minutes on some random scenes.
const char* const kChart = "chart scene.json -o charts --rays 100 --rounds 1 --no-images";

Result run_verb(const Folder& folder, const std::string& verb) {
  return folder.run_script(fmt::format("ulimit -t {}\n\"$fathom\" {}", is_sanitized() ? 300 : 30, verb));
}

// True if `dump --region` refused a scene that has no regions, because cutting it does not pay off.
bool has_no_regions(const Result& result) {
  return result.code == 65 && result.err.find("the scene has no regions") != std::string::npos;
}

void check_all(const std::string& scene) {
  const Folder folder;
  folder.write("scene.json", scene);
  std::vector<std::string> verbs(std::begin(kVerbs), std::end(kVerbs));
  if (!is_sanitized()) verbs.push_back(kChart);
  for (const std::string& verb : verbs) {
    const Result result = run_verb(folder, verb);
    INFO(verb << "\n" << scene.substr(0, 600) << "\n" << result.err.substr(0, 600));
    CHECK((result.code == 0 || has_no_regions(result)));
  }
}

TEST_CASE("shared graphs: every verb visits a node that is used in many ways once", "[runtime][limits][released]") {
  const std::string ball = R"({"type": "sphere", "radius": 1, "material": "lamp"})";
  check_all(doublings(ball, R"({"type": "union", "of": [$, $]})"));
  check_all(doublings(R"({"type": "union", "of": [{"type": "sphere", "radius": 1, "material": "glass"},
      {"type": "sphere", "radius": 2, "material": "water"}]})",
                      R"({"type": "union", "of": [$, $]})"));
  check_all(doublings(R"({"type": "union", "of": [{"type": "plane", "normal": [0, 1, 0], "offset": -9},
      {"type": "sphere", "radius": 1}]})",
                      R"({"type": "smooth_union", "k": 0.001, "of": [$, $]})"));
}

// The examples of docs/reference/gallery.md that are nodes, outlines extruded or revolved, and the node types in
// them.
struct Examples {
  Examples() {
    const std::string page = test::read_file(FATHOM_SOURCE_DIR "/docs/reference/gallery.md"), begin = "```json\n";
    for (std::size_t at = page.find(begin); at != page.npos; at = page.find(begin, at)) {
      at += begin.size();
      const std::string text = page.substr(at, page.find("```", at) - at);
      const nlohmann::json node = nlohmann::json::parse(text, nullptr, false);
      if (!node.is_object() || !node.contains("type")) continue;  // part of a scene
      add_types(node);
      const bool outline = compiler::find_node(node["type"].get<std::string>())->sort == compiler::Sort::Outline;
      nodes.push_back(outline ? fmt::format(R"({{"type": {}, "of": {}}})", kSolids[nodes.size() % 2], text) : text);
    }
  }
  void add_types(const nlohmann::json& value) {
    if (value.is_object() && value.contains("type")) types.insert(value["type"].get<std::string>());
    if (!value.is_structured()) return;
    for (const nlohmann::json& part : value) add_types(part);
  }
  static constexpr const char* kSolids[] = {R"("extrude", "half_depth": 0.3)", R"("revolve")"};
  std::vector<std::string> nodes;
  std::set<std::string> types;
};

const Examples& examples() {
  static const Examples all;
  return all;
}

const char* const kMaterials = R"("materials": {
    "lamp": {"type": "emissive", "emission": [1, 2, 3]}, "clay": {"type": "diffuse"},
    "glass": {"type": "transparent"}, "water": {"type": "transparent", "ior": 1.3},
    "paint": {"type": "principled", "color": [0.2, 0.4, 0.6], "roughness": 0.4}})";

// Writes one random scene per seed.
class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}

  std::string scene() {
    const int count = 8 + random_.below(30);
    std::string nodes;
    for (int i = 0; i < count; ++i) nodes += fmt::format("{}\n  \"n{}\": {}", i == 0 ? "" : ",", i, node(i));
    const std::string first = use(count), second = use(count);
    return fmt::format(R"({{"version": 1, "film": {{"width": 8, "height": 8}}, "render": {{"spp": 1}}, {},
"nodes": {{{}}},
"objects": [{}, {}, {}]}})",
                       kMaterials, nodes, first, second, use(count));
  }

 private:
  std::string material() {
    const char* const names[] = {"lamp", "clay", "glass", "water", "paint"};
    return fmt::format(R"(, "material": "{}")", names[random_.below(5)]);
  }

  std::string vector(double lo, double hi) {
    const double x = random_.uniform(lo, hi), y = random_.uniform(lo, hi);
    return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", x, y, random_.uniform(lo, hi));
  }

  // Returns a use of a node before `i`, usually one of the last.
  std::string use(int i) {
    int back = 1;
    while (back < i && random_.chance(0.5)) ++back;
    std::string text = fmt::format(R"({{"use": "n{}")", i - back);
    const int moved = random_.below(10);
    if (moved < 3) text += R"(, "translate": )" + vector(-1, 1);
    if (moved == 3) text += fmt::format(R"(, "scale": {:.3f})", random_.uniform(0.5, 1.5));
    if (moved == 4) text += R"(, "scale": )" + vector(0.5, 1.5);
    if (moved == 5) text += fmt::format(R"(, "rotate": [0, {:.1f}, 0])", random_.uniform(0, 90));
    if (random_.chance(0.2)) text += material();
    return text + "}";
  }

  std::string node(int i) {
    const int choice = i < 3 ? 0 : random_.below(10);
    std::string text = choice == 0 ? primitive() : choice < 6 ? combinator(i) : alteration(i);
    if (random_.chance(0.3)) text.insert(text.size() - 1, material());
    return text;
  }

  std::string primitive() {
    const auto& nodes = examples().nodes;
    if (random_.chance(0.7)) return nodes[static_cast<std::size_t>(random_.below(static_cast<int>(nodes.size())))];
    const char* const shapes[] = {
        R"({"type": "plane", "normal": [0, 1, 0], "offset": -1})",
        R"({"type": "expression", "formula": "0.1*sin(5*x) + x^2 + y^2 + z^2 - 0.5", "half_size": [1, 1, 1]})",
    };
    return shapes[random_.below(2)];
  }

  std::string combinator(int i) {
    const char* const kinds[] = {R"("union")",
                                 R"("intersection")",
                                 R"("subtraction")",
                                 R"("xor")",
                                 R"("smooth_union", "k": 0.2)",
                                 R"("smooth_subtraction", "k": 0.1)",
                                 R"("smooth_intersection", "k": 0.05)",
                                 R"("chamfer_union", "radius": 0.1)",
                                 R"("round_union", "radius": 0.1)",
                                 R"("stairs_union", "radius": 0.2)",
                                 R"("morph", "t": 0.4)"};
    const char* const kind = kinds[random_.below(11)];
    const std::string first = use(i);
    return fmt::format(R"({{"type": {}, "of": [{}, {}]}})", kind, first, use(i));
  }

  // Returns an alteration of a node cut to a box: repeating and bending nodes need a bounded child.
  std::string alteration(int i) {
    const char* const kinds[] = {R"("round", "radius": 0.05)",
                                 R"("onion", "thickness": 0.05)",
                                 R"("complement")",
                                 R"("elongate", "half_size": [0.2, 0, 0.1])",
                                 R"("mirror", "normal": [1, 0, 0])",
                                 R"("repetition", "period": [3, 0, 2], "count": [3, 0, 3])",
                                 R"("repetition", "period": [3, 3, 0], "jitter": [0.2, 0.1, 0])",
                                 R"("polar_repetition", "count": 5)",
                                 R"("twist", "turn": 30)",
                                 R"("bend", "turn": 20)",
                                 R"("taper", "bottom": 1, "top": 0.7, "half_height": 1)",
                                 R"("displacement", "formula": "sin(5*x)*sin(4*y)*0.02")"};
    const char* const kind = kinds[random_.below(12)];
    return fmt::format(
        R"({{"type": {}, "of": {{"type": "intersection", "of": [{}, {{"type": "box", "half_size": [2, 1, 1]}}]}}}})",
        kind, use(i));
  }

  Random random_;
};

// Returns how many scenes of these seeds rendered. The others were refused, because of a limit or an unbounded node.
int rendered(std::uint64_t first, std::uint64_t last) {
  int done = 0;
  for (std::uint64_t seed = first; seed < last; ++seed) {
    const Folder folder;
    folder.write("scene.json", Writer(seed).scene());
    for (const std::string verb : kVerbs) {
      const Result result = run_verb(folder, verb);
      INFO("seed " << seed << ": " << verb << "\n" << result.err.substr(0, 600));
      const bool refused = result.code == (verb.starts_with("check") ? 1 : 65);
      const bool missing = !folder.has("scene.fbc") && result.code == 74;
      CHECK((result.code == 0 || has_no_regions(result) || missing ||
             (refused && result.err.find("error[E") != std::string::npos)));
    }
    done += folder.has("scene.png");
  }
  return done;
}

TEST_CASE("shared graphs: they are drawn of every type of node", "[runtime][limits]") {
  for (const compiler::NodeSpec& row : compiler::node_table()) {
    if (row.category == compiler::Category::Function || row.category == compiler::Category::Internal) continue;
    INFO(row.name);
    CHECK(examples().types.count(std::string(row.name)) == 1);
  }
}

TEST_CASE("shared graphs: random ones end in every verb", "[runtime][limits]") { CHECK(rendered(1, 5) >= 2); }

TEST_CASE("shared graphs: many random ones end in every verb", "[runtime][limits][heavy]") {
  CHECK(rendered(100, 120) >= 8);
}

}  // namespace

}  // namespace fathom::shared_graphs_test
