// The folders' order: vm <- compiler <- runtime, and that of runtime's own. Reads every include of the sources.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fathom::layers_test {

namespace {

namespace fs = std::filesystem;

// The quoted includes of a file, from the repository's root.
std::set<std::string> includes(const fs::path& file) {
  std::ifstream in(file);
  std::set<std::string> result;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("#include \"")) continue;
    const std::size_t begin = line.find('"') + 1;
    result.insert(line.substr(begin, line.find('"', begin) - begin));
  }
  return result;
}

std::string top(const std::string& path) { return path.substr(0, path.find('/')); }

}  // namespace

TEST_CASE("a folder includes only folders before it", "[layers]") {
  const std::map<std::string, std::set<std::string>> allowed = {
      {"vm", {"vm", "hwy"}},
      {"compiler", {"vm", "compiler"}},
      {"runtime", {"vm", "compiler", "runtime", "hwy"}},
  };
  for (const auto& [folder, may] : allowed) {
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(FATHOM_SOURCE_DIR) / folder)) {
      if (!entry.is_regular_file()) continue;
      ++files;
      for (const std::string& include : includes(entry.path())) {
        CAPTURE(entry.path().string(), include);
        CHECK(may.count(top(include)) == 1);
      }
    }
    CHECK(files > 10);
  }
}

// The folders of runtime/, each after those that it includes; "" is runtime/ itself.
const std::vector<std::string> kRuntime = {"base",     "sampling", "image", "film",  "denoise", "field", "march",
                                           "material", "light",    "path",  "slice", "",        "chart", "measure"};

// "runtime/film/film.h" -> "film", "runtime/render.h" -> "".
std::string runtime_folder(const std::string& path) {
  const std::string within = path.substr(std::string("runtime/").size());
  const std::size_t slash = within.find('/');
  return slash == std::string::npos ? "" : within.substr(0, slash);
}

TEST_CASE("a folder of the renderer includes only folders before it", "[layers]") {
  const auto position = [](const std::string& folder) { return std::ranges::find(kRuntime, folder); };
  std::set<std::string> seen;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "runtime")) {
    if (!entry.is_regular_file()) continue;
    const std::string folder = runtime_folder(fs::relative(entry.path(), FATHOM_SOURCE_DIR).string());
    if (folder == "cli") continue;
    seen.insert(folder);
    CAPTURE(entry.path().string());
    REQUIRE(position(folder) != kRuntime.end());
    for (const std::string& include : includes(entry.path())) {
      if (!include.starts_with("runtime/")) continue;
      CAPTURE(include);
      CHECK(position(runtime_folder(include)) <= position(folder));
    }
  }
  CHECK(seen.size() == kRuntime.size());
}

TEST_CASE("the renderer sees of the compiler only what it hands over", "[layers]") {
  for (const std::string& folder : kRuntime) {
    if (folder == "chart") continue;
    for (const auto& entry : fs::directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "runtime" / folder)) {
      if (!entry.is_regular_file()) continue;
      for (const std::string& include : includes(entry.path())) {
        CAPTURE(entry.path().string(), include);
        CHECK((top(include) != "compiler" || include == "compiler/compiled_scene.h" || include == "compiler/box.h"));
      }
    }
  }
}

TEST_CASE("charts know numbers and pictures, not scenes and rays", "[layers]") {
  for (const auto& entry : fs::directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "runtime/chart")) {
    for (const std::string& include : includes(entry.path())) {
      CAPTURE(entry.path().string(), include);
      CHECK((include.starts_with("runtime/chart/") || include == "runtime/image/image.h"));
    }
  }
}

}  // namespace fathom::layers_test
