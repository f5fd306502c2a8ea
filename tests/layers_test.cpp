// The order of the source folders, read from every include. A folder includes only itself and folders before it, and
// no two units include each other.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace fathom::layers_test {

namespace {

namespace fs = std::filesystem;

// Every folder with sources, each after the folders that it includes.
const std::vector<std::string> kFolders = {
    "vm/program",
    "vm/encoding",
    "vm/number",
    "vm/interpret",
    "vm/range",
    "vm/prune",
    "vm/record",
    "vm/native",
    "compiler/source",
    "compiler/geometry",
    "compiler/graph",
    "compiler/scene",
    "compiler/shapes",
    "compiler/lower",
    "compiler/derive",
    "compiler/passes",
    "compiler/frontend/syntax",
    "compiler/frontend/formula",
    "compiler/frontend/records",
    "compiler/frontend/elaborate",
    "compiler/frontend/formats",
    "compiler/frontend/text/parse",
    "compiler/frontend/text/evaluate",
    "compiler/frontend/text",
    "compiler/frontend",
    "compiler/analysis",
    "compiler/emit",
    "compiler/artefact",
    "compiler",
    "runtime/base",
    "runtime/sampling",
    "runtime/image",
    "runtime/film",
    "runtime/denoise",
    "runtime/field",
    "runtime/march",
    "runtime/material",
    "runtime/light",
    "runtime/path",
    "runtime/slice",
    "runtime/mesh/lattice",
    "runtime/mesh/lost",
    "runtime/mesh",
    "runtime/mesh/files",
    "runtime",
    "runtime/chart",
    "runtime/live",
    "runtime/load",
    "runtime/measure",
    "runtime/cli/options",
    "runtime/cli/dump",
    "runtime/cli/input",
    "runtime/cli/request",
    "runtime/cli/picture",
    "runtime/cli/frames",
    "runtime/cli/plan",
    "runtime/cli/report",
    "runtime/cli/view/page",
    "runtime/cli/view",
    "runtime/cli",
    "bindings/include/fathom",
    "bindings/cpp",
    "bindings/c",
    "bindings/python",
    "bindings",
};

// Folders of runtime/ that are not the renderer's: they use any part of the compiler.
bool is_client(const std::string& file) {
  return file.starts_with("runtime/cli/") || file.starts_with("runtime/live/") || file.starts_with("runtime/load/");
}

// Max number of files in a folder, so that a reader still finds a file.
constexpr int kMaxFiles = 35;

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

// "vm/range/slope.h" and "vm/range/slope.cpp" are the unit "vm/range/slope".
std::string unit_of(const std::string& path) { return path.substr(0, path.find('.')); }

// The files of vm/, compiler/, runtime/ and bindings/ and their quoted includes, as paths from the repository's root.
const std::map<std::string, std::set<std::string>>& all_includes() {
  static const std::map<std::string, std::set<std::string>> result = [] {
    std::map<std::string, std::set<std::string>> files;
    for (const char* top : {"vm", "compiler", "runtime", "bindings"}) {
      for (const auto& entry : fs::recursive_directory_iterator(fs::path(FATHOM_SOURCE_DIR) / top)) {
        if (!entry.is_regular_file() || entry.path().filename() == "CMakeLists.txt") continue;
        std::set<std::string>& includes = files[fs::relative(entry.path(), FATHOM_SOURCE_DIR).string()];
        std::ifstream in(entry.path());
        for (std::string line; std::getline(in, line);) {
          if (!line.starts_with("#include \"")) continue;
          const std::size_t begin = line.find('"') + 1;
          includes.insert(line.substr(begin, line.find('"', begin) - begin));
        }
      }
    }
    return files;
  }();
  return result;
}

// Returns a path of includes from a unit back to itself, or an empty path when there is none.
std::vector<std::string> find_circle() {
  std::map<std::string, std::set<std::string>> graph;
  for (const auto& [file, includes] : all_includes()) {
    for (const std::string& include : includes) {
      if (all_includes().contains(include) && unit_of(include) != unit_of(file)) {
        graph[unit_of(file)].insert(unit_of(include));
      }
    }
  }
  std::set<std::string> finished;
  std::vector<std::string> path;
  const std::function<bool(const std::string&)> leads_back = [&](const std::string& unit) {
    if (const auto begin = std::ranges::find(path, unit); begin != path.end()) {
      path.erase(path.begin(), begin);
      return true;
    }
    if (finished.contains(unit)) return false;
    path.push_back(unit);
    if (std::ranges::any_of(graph[unit], leads_back)) return true;
    path.pop_back();
    finished.insert(unit);
    return false;
  };
  std::vector<std::string> units;
  for (const auto& [unit, includes] : graph) units.push_back(unit);
  std::ranges::any_of(units, leads_back);
  return path;
}

}  // namespace

TEST_CASE("a folder includes only folders before it", "[house][layers]") {
  const auto position = [](const std::string& folder) { return std::ranges::find(kFolders, folder); };
  std::map<std::string, int> counts;
  for (const auto& [file, includes] : all_includes()) {
    CAPTURE(file);
    const std::string folder = folder_of(file);
    ++counts[folder];
    REQUIRE(position(folder) != kFolders.end());
    for (const std::string& include : includes) {
      CAPTURE(include);
      if (include.starts_with("hwy/")) continue;
      REQUIRE(all_includes().contains(include));
      CHECK(position(folder_of(include)) <= position(folder));
    }
  }
  CHECK(counts.size() == kFolders.size());
  for (const auto& [folder, count] : counts) {
    CAPTURE(folder, count);
    CHECK(count <= kMaxFiles);
  }
}

TEST_CASE("no two units include each other", "[house][layers]") {
  for (const std::string& unit : find_circle()) FAIL_CHECK(unit);
  CHECK(all_includes().size() > 500);
}

TEST_CASE("the renderer sees of the compiler only what it hands over", "[house][layers]") {
  for (const auto& [file, includes] : all_includes()) {
    if (!file.starts_with("runtime/") || is_client(file)) continue;
    for (const std::string& include : includes) {
      CAPTURE(file, include);
      CHECK((!include.starts_with("compiler/") || include.starts_with("compiler/scene/") ||
             include.starts_with("compiler/geometry/box")));
    }
  }
}

TEST_CASE("the library does without the program", "[house][layers]") {
  for (const auto& [file, includes] : all_includes()) {
    if (!file.starts_with("bindings/")) continue;
    for (const std::string& include : includes) {
      CAPTURE(file, include);
      CHECK_FALSE(include.starts_with("runtime/cli/"));
    }
  }
}

TEST_CASE("charts know numbers and pictures, not scenes and rays", "[house][layers]") {
  for (const auto& [file, includes] : all_includes()) {
    if (folder_of(file) != "runtime/chart") continue;
    for (const std::string& include : includes) {
      CAPTURE(file, include);
      CHECK((include.starts_with("runtime/chart/") || include == "runtime/image/image.h" ||
             include.starts_with("vm/number/")));
    }
  }
}

}  // namespace fathom::layers_test
