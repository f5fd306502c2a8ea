#include "tests/support/golden.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/catch.h"

namespace fathom::test {

namespace fs = std::filesystem;

namespace {
const std::string kSeparator = "----- expected\n";
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

std::vector<fs::path> golden_files(const std::string& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "tests/golden" / folder)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

void check_golden(const std::string& folder, const std::function<std::string(const std::string& input)>& print) {
  const bool update = std::getenv("FATHOM_UPDATE_GOLDEN") != nullptr;
  const std::vector<fs::path> files = golden_files(folder);
  REQUIRE(!files.empty());
  for (const fs::path& path : files) {
    CAPTURE(path.filename().string());
    const std::string text = read_file(path);
    const std::size_t end = text.find(kSeparator);
    REQUIRE(end != std::string::npos);
    const std::string input = text.substr(0, end), actual = print(input);
    if (update) std::ofstream(path, std::ios::binary) << input << kSeparator << actual;
    if (!update) CHECK(actual == text.substr(end + kSeparator.size()));
  }
}

}  // namespace fathom::test
