// Compares the schema with the compiler, which has the last word. The compiler rejects everything that the schema
// rejects. The schema rejects everything that the compiler rejects, as far as a schema can express the rule.
#include "compiler/frontend/records/schema.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "compiler/compile.h"
#include "compiler/frontend/text/read_text.h"
#include "compiler/shapes/node_table.h"
#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/schema_check.h"

namespace fathom::schema_test {

namespace {

using namespace fathom::compiler;
using fathom::test::golden_files;
using fathom::test::read_file;
using fathom::test::schema_problem;
using nlohmann::json;
namespace fs = std::filesystem;

// Error codes that the schema can express: types, names and number of properties, ranges of single numbers.
const std::set<std::string> kStructural = {"E0101", "E0102", "E0103", "E0104", "E0105",
                                           "E0106", "E0107", "E0108", "E0201", "E0301"};
// All other codes, by prefix, with the reason why a schema cannot express them.
const std::map<std::string, std::string> kBeyond = {
    {"E00", "the text is not JSON at all, or names a property twice"},
    {"E0109", "how deep patterns nest"},
    {"E0202", "a name must occur elsewhere in the file"},
    {"E0203", "a name must occur elsewhere in the file"},
    {"E0204", "a walk along names"},
    {"E0302", "arithmetic over several parameters"},
    {"E0303", "arithmetic over several vectors"},
    {"E0304", "arithmetic over several vectors"},
    {"E0305", "the size of the program"},
    {"E0306", "what a node below, or one used by name, is"},
    {"E0307", "what a node below, or one used by name, is"},
    {"E0308", "what numbers a node comes to"},
    {"E0309", "which way a vector points"},
    {"E0310", "arithmetic over several vectors"},
    {"E0311", "what files there are"},
    {"E0312", "what limits are set"},
    {"E04", "the grammar of formulas, and the names in them"},
    {"E05", "what the command line says"},
    {"E06", "files of another format"},
    {"W0", "a warning; the scene is valid"},
};

json parse(const std::string& text) { return json::parse(text, nullptr, false, true); }

const json& schema() {
  static const json parsed = json::parse(scene_schema());
  return parsed;
}

// Returns the codes of the errors that the compiler reports.
std::set<std::string> compiler_errors(const std::string& text) {
  Diagnostics diagnostics;
  compile(Source("scene.json", text), diagnostics);
  std::set<std::string> codes;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    if (diagnostic.code[0] == 'E') codes.insert(std::string(diagnostic.code));
  }
  return codes;
}

bool beyond(const std::string& code) {
  return std::any_of(kBeyond.begin(), kBeyond.end(), [&](const auto& row) { return code.starts_with(row.first); });
}

// Calls `use` with every value of a tree, including the root. `use` may change the value and must restore it.
template <typename Use>
void for_each_value(json& value, const Use& use) {
  use(value);
  if (!value.is_structured()) return;
  for (auto& item : value) for_each_value(item, use);
}

// Checks that the schema and the compiler agree on `scene`, as far as a schema can tell.
void compare(const json& scene) {
  const std::string text = scene.dump();
  const std::set<std::string> errors = compiler_errors(text);
  const std::string problem = schema_problem(json::parse(text), schema());
  const bool structural =
      std::any_of(errors.begin(), errors.end(), [](const std::string& code) { return kStructural.count(code) > 0; });
  CAPTURE(text, problem, errors);
  CHECK((problem.empty() || !errors.empty()));
  CHECK((!structural || !problem.empty()));
}

}  // namespace

TEST_CASE("schema: every scene that comes with the program is valid", "[frontend][heavy][schema]") {
  int scenes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(FATHOM_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".json") continue;
    CAPTURE(entry.path().string());
    CHECK(schema_problem(parse(read_file(entry.path())), schema()) == "");
    ++scenes;
  }
  CHECK(scenes > 5);
}

TEST_CASE("schema: the compiler's golden mistakes are found, or known to be beyond a schema", "[frontend][schema]") {
  for (const fs::path& path : golden_files("diagnostics")) {
    const std::string name = path.filename().string(), whole = read_file(path);
    if (name.starts_with("layout") || name.starts_with("E07")) continue;  // E07xx are for listings
    const std::string text = whole.substr(0, whole.find("----- expected\n")), code = name.substr(0, 5);
    if (is_text_scene(text)) continue;
    CAPTURE(name);
    CHECK((kStructural.count(code) > 0) != beyond(code));
    // The schema knows neither a formula's value nor the texts of colours.
    const bool computed = name.ends_with("_formula.txt") || name.ends_with("_color_text.txt");
    if (computed || name.starts_with("E06")) continue;
    if (kStructural.count(code) > 0) {
      CHECK(schema_problem(parse(text), schema()) != "");
    } else if (!name.starts_with("E00") && code != "E0408") {  // numbers in E0408 may be too large for any property
      CHECK(schema_problem(parse(text), schema()) == "");
    }
  }
}

// Changes each property of every record of two scenes in turn: removed, misnamed, and with values of other types and
// sizes.
TEST_CASE("schema: no change to a scene makes it disagree with the compiler", "[frontend][heavy][schema]") {
  json scene = parse(read_file(fs::path(FATHOM_SOURCE_DIR) / "scenes/primitives.json"));
  scene["camera"]["type"] = "perspective";
  scene["render"] = {{"spp", 1}, {"rr_depth", 0}, {"tile", 8}, {"seed", 3}, {"far", 100}, {"noise_threshold", 0.1}};
  scene["objects"][0]["rotate"] = {{"axis", {0, 1, 0}}, {"angle", 30}};
  scene["nodes"] = {{"ball", {{"type", "sphere"}, {"radius", 1}}}};
  const json ball = {{"use", "ball"}, {"scale", 2}, {"name", "b"}};
  scene["objects"].push_back({{"type", "onion"}, {"thickness", 0.1}, {"of", ball}});
  scene["objects"].push_back({{"type", "smooth_union"}, {"k", 0.1}, {"of", {ball, ball}}, {"scale", {1, 2, 1}}});
  const json others[] = {nullptr,       true,           0,         -1,         0.5,   2, 1e20, "diffuse", "sphere",
                         json::array(), json::object(), {0, 0, 0}, {1, -1, 1}, {1, 2}};
  int changes = 0;
  for_each_value(scene, [&](json& value) {
    if (!value.is_object()) return;
    const json kept = value;
    for (const auto& [name, old] : kept.items()) {
      value.erase(name);
      compare(scene);
      value[name + "x"] = old;
      compare(scene);
      value = kept;
      for (const json& other : others) {
        value[name] = other;
        compare(scene);
        ++changes;
      }
      value = kept;
    }
  });
  CHECK(changes > 1000);
}

// A row of the document is a line "| `type`, `type` | parameters |".
TEST_CASE("docs/reference/scene-file.md has a row for every type of node, with its parameters",
          "[frontend][schema]") {
  std::stringstream page(read_file(FATHOM_SOURCE_DIR "/docs/reference/scene-file.md"));
  std::vector<std::pair<std::string, std::string>> rows;
  for (std::string line; std::getline(page, line);) {
    const std::size_t cell = line.starts_with("| ") ? line.find(" | ") : line.npos;
    if (cell != line.npos) rows.emplace_back(line.substr(0, cell), line.substr(cell));
  }
  const auto has = [](const std::string& cell, std::string_view name) {
    return cell.find("`" + std::string(name) + "`") != std::string::npos;
  };
  for (const NodeSpec& node : node_table()) {
    if (node.category == Category::Internal || node.category == Category::Function) continue;
    INFO(node.name);
    CHECK(std::any_of(rows.begin(), rows.end(), [&](const auto& row) {
      return has(row.first, node.name) &&
             std::all_of(node.params.begin(), node.params.end(),
                         [&](const ParamSpec& param) { return has(row.second, param.name); });
    }));
  }
}

TEST_CASE("schema: every property of the tables is described", "[frontend][schema]") {
  json copy = schema();
  for_each_value(copy, [](json& value) {
    if (!value.is_object() || !value.contains("properties") || !value["properties"].is_object()) return;
    for (const auto& [name, property] : value["properties"].items()) {
      CAPTURE(name);
      CHECK_FALSE(property.value("description", "").empty());
    }
  });
  CHECK(schema()["$defs"]["material"]["oneOf"][3]["properties"]["ior"]["default"] == 1.5);
  CHECK(schema()["properties"]["version"]["const"] == 1);
  CHECK(schema()["$defs"]["render"]["properties"]["seed"]["anyOf"][0]["maximum"] == ~std::uint64_t{0});
}

}  // namespace fathom::schema_test
