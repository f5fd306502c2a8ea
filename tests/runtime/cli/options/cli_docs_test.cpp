// Runs the commands that README.md and other pages show on the scenes of these pages: they must end well, and the
// output must be as shown. The reference shows examples in two notations, which must be the same.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
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

void write_scenes(const Folder& folder, const std::string& page) {
  for (const Block& block : blocks_of(page)) {
    if (block.language == "json" || block.language == "fathom") folder.write(file_name(block.text), block.text);
  }
}

int check_page(const Folder& folder, const std::string& page) {
  int commands = 0;
  write_scenes(folder, page);
  for (const Block& block : blocks_of(page)) {
    if (block.language == "console") commands += check_console(folder, block.text);
  }
  return commands;
}

// Commands that no test in one process can run, by a part of them.
struct Unrun {
  std::string_view part, reason;
};

constexpr Unrun kUnrun[] = {
    {"scripts/", "builds, installs or submits: scripts/test-distributions and tests/suites run these"},
    {"tests/suites/", "runs builds for an hour"},
    {"cmake ", "builds: tests/suites/package runs it"},
    {"qemu-aarch64 ", "needs a build for another processor: tests/suites/compilers"},
    {"apt install ", "changes the machine: tests/suites/package"},
    {"pip install ", "builds: tests/suites/python runs it"},
    {"alias ", "is the shell's"},
    {"--unit env", "needs a queue's variable"},
    {"--unit K", "names no unit"},
    {"aws ", "needs a network"},
    {"/farm/", "needs hosts that share a folder: tests/suites/farm"},
    {"fathom view", "opens a browser and serves it until Ctrl-C"},
    {"--watch", "renders until Ctrl-C"},
};

// Returns the commands that a page shows, except those of console blocks: lines of ```sh blocks, lines indented by
// four blanks that begin with the program, and the program in the text with a file or the code of an error.
std::vector<std::string> commands_of(const std::string& page) {
  static const std::regex continued(R"(\\\n)"), comment("  +#.*"), indented("    ((build/release/)?fathom .*)"),
      quoted("`((build/release/)?fathom [^`]*(\\.| E0)[^`]*)`");
  std::vector<std::string> commands;
  const auto add = [&](const std::string& line) { commands.push_back(std::regex_replace(line, comment, "")); };
  std::string language;
  bool within = false;
  std::istringstream lines(std::regex_replace(page, continued, " "));
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (line.starts_with("```")) {
      within = !within;
      language = line.substr(3);
    } else if (within) {
      if (language == "sh" && !line.empty()) add(line);
    } else if (std::regex_match(line, match, indented)) {
      add(match[1]);
    } else {
      for (std::sregex_iterator each(line.begin(), line.end(), quoted); each != std::sregex_iterator(); ++each) {
        add((*each)[1]);
      }
    }
  }
  return commands;
}

// Returns the command with less work, without what only a shell understands.
std::string shortened(std::string command) {
  static const std::pair<std::regex, const char*> changes[] = {
      {std::regex(" [|>] .*"), ""},  // what becomes of the output
      {std::regex("^build/release/"), ""},
      {std::regex("~/"), "home/"},
      {std::regex(" --size [^ ]+"), ""},
      {std::regex(" (-s|--probe) [0-9]{4,}"), " $1 8"},
      {std::regex("--sample-range 0:512"), "--sample-range 0:4"},
      {std::regex("--sample-range 512:1024"), "--sample-range 4:8"},
      {std::regex("--frames (all|0:[0-9]+)"), "--frames 0:2"},
      {std::regex("--unit 7"), "--units 0:2"},
  };
  for (const auto& [from, to] : changes) command = std::regex_replace(command, from, to);
  static const std::regex sized("fathom +(render|plan|report|chart) .*"), planned(".* --(plan|status) .*");
  if (std::regex_match(command, sized) && !std::regex_match(command, planned)) command += " --size 16x9";
  if (command.starts_with("fathom chart ")) command += " --rays 100 --rounds 1 --seeds 2 -s 4 --reference-spp 8";
  if (command.starts_with("fathom mesh ")) command += " --resolution 24";
  return command;
}

// Makes the files that pages take for granted: a user's scenes, a listing, a model, pictures, parts of a picture.
void write_inputs(const Folder& folder) {
  std::filesystem::create_directory_symlink(FATHOM_SOURCE_DIR "/scenes", folder.path() / "scenes");
  const std::string scene = "fathom 1\nbackground [1, 1, 1]\nobject \"ball\" sphere(0.5)\n";
  folder.write("scene.fathom", scene);
  folder.write("part.fathom", scene);
  folder.write("small.fathom",
               "fathom 1\ndef gear(teeth) =\n  let radius = require(teeth >= 6, \"a gear needs 6 teeth or more\", "
               "teeth/10)\n  in cylinder(radius, 0.2)\nobject gear(4)\n");
  folder.write("model.vm", read_file(FATHOM_SOURCE_DIR "/tests/data/hi.vm"));
  folder.write("listing.txt", folder.run("dump --stage file scene.fathom").out);
  for (const char* command : {"convert scene.fathom -o scene.json",
                              "render scene.fathom -o out.png -o reference.png -o render.exr --size 16x9 -s 4",
                              "render scene.fathom -o a.film --size 16x9 -s 8 --sample-range 0:4",
                              "render scene.fathom -o b.film --size 16x9 -s 8 --sample-range 4:8"}) {
    REQUIRE(folder.run(command).code == 0);
  }
}

// Returns README, the tutorials, the how-tos and the list of commands, by name.
std::vector<std::pair<std::string, std::string>> pages_with_commands() {
  std::vector<std::string> names = {"README.md", "docs/reference/commands.md"};
  for (const char* folder : {"docs/tutorial/", "docs/how-to/"}) {
    for (const auto& file : std::filesystem::directory_iterator(std::string(FATHOM_SOURCE_DIR "/") + folder)) {
      if (file.path().extension() == ".md") names.push_back(folder + file.path().filename().string());
    }
  }
  std::ranges::sort(names);
  std::vector<std::pair<std::string, std::string>> pages;
  for (const std::string& name : names) pages.emplace_back(name, read_file(FATHOM_SOURCE_DIR "/" + name));
  return pages;
}

// Returns a scene with the part of a JSON scene that the reference shows.
std::string completed(std::string part) {
  if (part.find("\"version\"") != part.npos) return part;
  if (part.starts_with("{\"type\"")) return R"({"version": 1, "objects": [)" + part + "]}";
  if (part.starts_with('{')) return R"({"version": 1, )" + part.substr(1);
  if (part.find("\"objects\"") == part.npos) part += R"(, "objects": [{"type": "sphere", "radius": 1}])";
  return R"({"version": 1, )" + part + "}";
}

}  // namespace

TEST_CASE("docs: the commands of README, tutorials, how-tos and of the list of commands run", "[cli][docs]") {
  const auto pages = pages_with_commands();
  std::set<std::string_view> unrun;
  int count = 0;
  for (const auto& [name, page] : pages) {
    const Folder folder;
    write_inputs(folder);
    for (const auto& [other, text] : pages) write_scenes(folder, text);  // farm.md renders the scene of animate.md
    count += check_page(folder, page);
    for (const std::string& command : commands_of(page)) {
      CAPTURE(name, command);
      const auto found =
          std::ranges::find_if(kUnrun, [&](const Unrun& each) { return command.find(each.part) != command.npos; });
      if (found != std::end(kUnrun)) {
        unrun.insert(found->part);
        continue;
      }
      const std::string line = shortened(command);
      REQUIRE(line.starts_with("fathom "));
      const Result result = folder.run(line.substr(7));
      INFO(result.err);
      CHECK(result.code == 0);
      ++count;
    }
  }
  CHECK(unrun.size() == std::size(kUnrun));  // no part without a command
  CHECK(count >= 75);
}

TEST_CASE("docs: the reference shows each example as a text and as the same JSON", "[cli][docs]") {
  const Folder folder;
  int pairs = 0;
  for (const char* page : {"scene-file", "materials", "gallery"}) {
    const std::string text = read_file(FATHOM_SOURCE_DIR "/docs/reference/" + std::string(page) + ".md");
    const std::vector<Block> blocks = blocks_of(text);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (blocks[i].language != "json") continue;
      CAPTURE(page, blocks[i].text);
      REQUIRE((i > 0 && blocks[i - 1].language == "fathom"));
      folder.write("example.json", completed(blocks[i].text));
      const Result result = folder.run("convert -q example.json");
      CHECK(result.code == 0);
      CHECK_THAT(result.out, Catch::Contains(blocks[i - 1].text));
      ++pairs;
    }
  }
  CHECK(pairs >= 100);
}

TEST_CASE("docs: each pass prints the graphs before and after it as its section shows them", "[cli][docs]") {
  CHECK(check_page(Folder(), read_file(FATHOM_SOURCE_DIR "/docs/explanation/passes.md")) >= 20);
}

TEST_CASE("docs: the scenes of the language's page are sound and laid out", "[cli][docs]") {
  const Folder folder;
  const std::string page = read_file(FATHOM_SOURCE_DIR "/docs/tutorial/language.md");
  write_scenes(folder, page);
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

TEST_CASE("docs: README shows scenes/melt.fathom", "[cli][docs]") {
  const std::string melt = read_file(FATHOM_SOURCE_DIR "/scenes/melt.fathom");
  CHECK(melt.starts_with("// melt.fathom"));
  const std::string page = read_file(FATHOM_SOURCE_DIR "/README.md");
  CHECK(page.find("```fathom\n" + melt + "```\n") != std::string::npos);
}

}  // namespace fathom::cli_docs_test
