// Runs the commands that README.md and other pages show on the scenes of these pages: the output must be as shown.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/program.h"

namespace fathom::cli_docs_test {

namespace {

using namespace fathom::test;

struct Block {
  std::string language, text;
};

// Returns the text between each ```language and ``` of a page, in order.
std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  bool within = false;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      within = !within;
      if (within) blocks.push_back({line.substr(3), ""});
    } else if (within) {
      blocks.back().text += line + '\n';
    }
  }
  REQUIRE_FALSE(within);
  return blocks;
}

// Returns the file name of a scene block that begins with "// file" or "// file: ...".
std::string file_name(const std::string& scene) {
  REQUIRE(scene.starts_with("// "));
  const std::size_t end = scene.find_first_of(":\n");
  return scene.substr(3, end - 3);
}

// Runs each "$ command" of a console block and compares the output with the lines that follow. A line "..." ends the
// comparison. Returns the number of commands.
int check_console(const Folder& folder, const std::string& block) {
  int commands = 0;
  std::size_t at = 0;
  while (block.compare(at, 2, "$ ") == 0) {
    const std::size_t end = block.find('\n', at);
    const std::string command = block.substr(at + 2, end - at - 2);
    const std::size_t next = std::min(block.find("\n$ ", end), block.size() - 1) + 1;
    std::string shown = block.substr(end + 1, next - end - 1);
    INFO(command);
    REQUIRE(command.starts_with("fathom "));
    std::string printed = folder.transcript(command.substr(7));
    if (shown.ends_with("\n...\n")) {
      shown.resize(shown.size() - 4);
      printed.resize(std::min(printed.size(), shown.size()));
    }
    CHECK(printed == shown);
    ++commands;
    at = next;
  }
  CHECK(commands > 0);
  return commands;
}

int check_page(const Folder& folder, const std::string& page) {
  int commands = 0;
  for (const Block& block : blocks_of(page)) {
    if (block.language == "json" || block.language == "fathom") folder.write(file_name(block.text), block.text);
    if (block.language == "console") commands += check_console(folder, block.text);
  }
  return commands;
}

}  // namespace

TEST_CASE("docs: the tutorial's commands print what it shows", "[cli][docs]") {
  CHECK(check_page(Folder(), read_file(FATHOM_SOURCE_DIR "/docs/tutorial/first-scene.md")) >= 5);
}

TEST_CASE("docs: each pass prints the graphs before and after it as its section shows them", "[cli][docs]") {
  CHECK(check_page(Folder(), read_file(FATHOM_SOURCE_DIR "/docs/explanation/passes.md")) >= 20);
}

TEST_CASE("docs: the scenes of the language's page are sound and laid out", "[cli][docs]") {
  const Folder folder;
  folder.write("small.fathom",
               "fathom 1\ndef gear(teeth) =\n  let radius = require(teeth >= 6, \"a gear needs 6 teeth or more\", "
               "teeth/10)\n  in cylinder(radius, 0.2)\nobject gear(4)\n");
  const std::string page = read_file(FATHOM_SOURCE_DIR "/docs/tutorial/language.md");
  CHECK(check_page(folder, page) == 1);
  int scenes = 0;
  for (const Block& block : blocks_of(page)) {
    if (block.language != "fathom") continue;
    const std::string name = file_name(block.text);
    CAPTURE(name);
    CHECK(folder.run("check " + name).err == "");
    CHECK(folder.run("fmt --check " + name).code == 0);
    CHECK(folder.run("render " + name + " -o a.png --size 32x18 -s 1").code == 0);
    ++scenes;
  }
  CHECK(scenes >= 5);
}

TEST_CASE("docs: README shows scenes/melt.fathom and its listing", "[cli][docs]") {
  const std::string melt = read_file(FATHOM_SOURCE_DIR "/scenes/melt.fathom");
  CHECK(melt.starts_with("// melt.fathom"));
  const std::string page = read_file(FATHOM_SOURCE_DIR "/README.md");
  CHECK(page.find("```fathom\n" + melt + "```\n") != std::string::npos);
  CHECK(check_page(Folder(), page) >= 1);
}

}  // namespace fathom::cli_docs_test
