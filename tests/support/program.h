// Runs command lines of the program in a temporary folder that contains two small scenes.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::test {

struct Result {
  int code;
  std::string out, err;
};

inline const char* const kBall = R"({
  "version": 1,
  "camera": {"position": [0, 0, 4], "target": [0, 0, 0]},
  "film": {"width": 32, "height": 16},
  "render": {"spp": 2},
  "background": [1, 1, 1],
  "objects": [{"name": "ball", "type": "sphere", "radius": 0.5}]
})";

inline const char* const kTwo = R"({
  "version": 1,
  "materials": {"red": {"type": "diffuse", "color": [1, 0, 0]}, "blue": {"type": "diffuse", "color": [0, 0, 1]}},
  "objects": [
    {"name": "left", "type": "sphere", "radius": 1, "translate": [-2, 0, 0], "material": "red"},
    {"name": "right", "type": "box", "half_size": [1, 1, 1], "translate": [2, 0, 0], "material": "blue"}
  ]
})";

std::string program_path();
bool is_sanitized();  // true if the program was built with the sanitizers

// Temporary folder in which command lines run. A start of the program takes longer than most verbs, so they run in
// the test's process.
class Folder : public TemporaryFolder {
 public:
  Folder() {
    write("ball.json", kBall);
    write("two.json", kTwo);
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(path() / name) << text; }
  std::string read(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(path() / name).rdbuf();
    return text.str();
  }
  bool has(const std::string& name) const { return std::filesystem::exists(path() / name); }

  // Runs a command line in this process. Quotes and backslashes in `arguments` are those of a shell; `in` is the
  // standard input. Signals, pipes, limits and variables of the environment need run_script().
  Result run(const std::string& arguments, const std::string& in = "") const;
  // As run(). Returns the output and the messages together, as a terminal shows them.
  std::string transcript(const std::string& arguments) const;
  // Runs shell commands in the folder; $fathom is the program.
  Result run_script(const std::string& lines) const;
};

// Width and height of a PNG, read from its header. Source: PNG specification, section 11.2.2.
inline std::pair<int, int> png_size(const std::string& bytes) {
  REQUIRE(bytes.size() > 24);
  const auto big_endian = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value * 256 + static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  return {big_endian(16), big_endian(20)};
}

}  // namespace fathom::test
