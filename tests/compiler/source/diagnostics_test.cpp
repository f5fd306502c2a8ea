// Golden tests of every diagnostic as the user sees it. tests/golden/diagnostics/*.txt hold a scene and, after the
// line "----- expected", the printed diagnostics. A scene may begin with lines `// -D name=number`, which set its
// parameters. Lints are on, as for `fathom check`. FATHOM_UPDATE_GOLDEN=1 in the environment rewrites the expected
// part.
#include "compiler/source/diagnostics.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "compiler/artefact/listing.h"
#include "compiler/compile.h"
#include "compiler/frontend/text/read_text.h"
#include "compiler/source/error_codes.h"
#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/import_folder.h"

namespace fathom::diagnostics_test {

namespace {

using namespace fathom::compiler;
namespace fs = std::filesystem;
using fathom::test::check_golden;
using fathom::test::golden_files;
using fathom::test::read_file;

Definitions definitions_in(const std::string& scene) {
  Definitions definitions;
  std::istringstream lines(scene);
  for (std::string line; std::getline(lines, line) && line.starts_with("// -D ");) {
    const std::size_t name = 6, middle = line.find('=');
    definitions.emplace_back(line.substr(name, middle - name), std::stod(line.substr(middle + 1)));
  }
  return definitions;
}

// Diagnoses a scene, or a listing, which begins with its header or with a comment of its own kind.
Diagnostics diagnose(Source& source) {
  Diagnostics diagnostics;
  if (source.text().starts_with("fathom 6") || source.text().starts_with(";")) {
    FileContents contents;
    read_listing(source, diagnostics, contents);
    return diagnostics;
  }
  CompileOptions options;
  options.definitions = definitions_in(source.text());
  options.lint = true;
  options.imports = test::imports_from(fs::path(FATHOM_SOURCE_DIR) / "tests/golden/imports");
  options.on_source = [&](const Source& whole) {
    if (!whole.imports().empty()) source = whole;
  };
  compile(source, diagnostics, options);
  return diagnostics;
}

TEST_CASE("golden diagnostics", "[source][diagnostics]") {
  check_golden("diagnostics", [](const std::string& input) {
    Source source(is_text_scene(input) && !input.starts_with("fathom 6") ? "scene.fathom" : "scene.json", input);
    const Diagnostics diagnostics = diagnose(source);
    return diagnostics.print(source, ErrorFormat::Text);
  });
}

TEST_CASE("every code has a golden file and every golden file shows its code", "[source][diagnostics]") {
  std::set<std::string> shown;
  for (const fs::path& path : golden_files("diagnostics")) {
    const std::string name = path.filename().string(), text = read_file(path);
    const std::string code = name.substr(0, 5);
    if (name.starts_with("layout")) continue;
    CAPTURE(name);
    CHECK(text.find("[" + code + "]", text.find("----- expected\n")) != std::string::npos);
    shown.insert(code);
  }
  for (const ErrorCode& row : kErrorCodes) {
    // Issued by `fathom check`, not by the compiler: cli_picture_warning_test.cpp.
    if (row.code == "W0516") continue;
    CAPTURE(std::string(row.code));
    CHECK(shown.count(std::string(row.code)) == 1);
    shown.erase(std::string(row.code));
  }
  CHECK(shown.empty());
}

TEST_CASE("codes are unique, and those in the compiler's sources are in the table", "[source][diagnostics]") {
  std::set<std::string> table;
  for (const ErrorCode& row : kErrorCodes) CHECK(table.insert(std::string(row.code)).second);
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "compiler")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = read_file(entry.path());
    for (const char* severity : {"\"E0", "\"W0"}) {
      for (std::size_t at = text.find(severity); at != std::string::npos; at = text.find(severity, at + 1)) {
        CAPTURE(entry.path().string(), text.substr(at + 1, 5));
        CHECK(table.count(text.substr(at + 1, 5)) == 1);
      }
    }
  }
}

TEST_CASE("short and JSON formats", "[source][diagnostics]") {
  Source source("toy.json", "{\"version\": 1,\n \"objects\": [{\"name\": \"ü\", \"type\": \"spehre\"}]}");
  const Diagnostics diagnostics = diagnose(source);
  CHECK(diagnostics.print(source, ErrorFormat::Short) ==
        "toy.json:2:36: error: unknown type of node `spehre` [E0201]\n");
  const std::string line = diagnostics.print(source, ErrorFormat::Json);
  CHECK(line.find('\n') == line.size() - 1);
  const auto json = nlohmann::json::parse(line);
  CHECK(json["severity"] == "error");
  CHECK(json["code"] == "E0201");
  CHECK(json["file"] == "toy.json");
  CHECK(json["line"] == 2);
  CHECK(json["column"] == 36);
  CHECK(json["end_column"] == 44);
  CHECK(source.text().substr(json["begin_byte"], 8) == "\"spehre\"");
  CHECK(json["help"][0].get<std::string>().starts_with("did you mean `sphere`?"));
}

TEST_CASE("colour changes nothing but escape sequences", "[source][diagnostics]") {
  Source source("toy.json", "{\"version\": 3}");
  const Diagnostics diagnostics = diagnose(source);
  const std::string colored = diagnostics.print(source, ErrorFormat::Text, true);
  std::string stripped;
  for (std::size_t i = 0; i < colored.size(); ++i) {
    if (colored[i] == '\x1b') {
      i = colored.find('m', i);
    } else {
      stripped += colored[i];
    }
  }
  CHECK(colored != stripped);
  CHECK(stripped == diagnostics.print(source, ErrorFormat::Text));
}

TEST_CASE("the gutter is as wide as the line number", "[source][diagnostics]") {
  Source source("toy.json", std::string(99, '\n') + "  x");
  Diagnostics diagnostics;
  diagnostics.error("E0102", {101, 102}, "message", "label", {"first", "second"});
  CHECK(diagnostics.print(source, ErrorFormat::Text) ==
        "error[E0102]: message\n"
        "    --> toy.json:100:3\n"
        "     |\n"
        " 100 |   x\n"
        "     |   ^ label\n"
        "     = help: first\n"
        "     = help: second\n");
}

TEST_CASE("carets stay on their line, and control characters do not reach the terminal", "[source][diagnostics]") {
  Source source("toy.json", "ab\x1b[2J\ncd");
  Diagnostics diagnostics;
  diagnostics.error("E0102", {1, 9}, "message");
  const std::string text = diagnostics.print(source, ErrorFormat::Text);
  CHECK(text.find(" 1 | ab\uFFFD[2J\n   |  ^^^^^\n") != std::string::npos);
}

TEST_CASE("of names as long as the file a message, its label and its help show the beginning",
          "[source][diagnostics]") {
  const Source source("a.json", "{}");
  const std::string name(100000, 'x');
  Diagnostics diagnostics;
  diagnostics.error("E0203", {0, 1}, name, name, {name, name});
  for (const ErrorFormat format : {ErrorFormat::Text, ErrorFormat::Short, ErrorFormat::Json}) {
    CHECK(diagnostics.print(source, format).size() < 10000);
  }
}

TEST_CASE("twenty errors are printed and the rest counted, in every format", "[source][diagnostics]") {
  Source source("toy.json", "x");
  Diagnostics diagnostics;
  for (int i = 0; i < 21; ++i) diagnostics.error("E0102", {0, 1}, "message");
  const std::string text = diagnostics.print(source, ErrorFormat::Text);
  CHECK(text.ends_with("\nand 1 more error\n"));
  const std::string lines = diagnostics.print(source, ErrorFormat::Short);
  CHECK(std::count(lines.begin(), lines.end(), '\n') == 21);
  CHECK(lines.ends_with("toy.json: and 1 more error\n"));
  const std::string json = diagnostics.print(source, ErrorFormat::Json);
  CHECK(std::count(json.begin(), json.end(), '\n') == 21);
}

// Regression: the list of nodes was checked from its end, so the last hundred errors were kept.
TEST_CASE("of more errors than are kept the first are", "[source][diagnostics]") {
  std::string text = "{\"version\": 1, \"objects\": [\n";
  for (int i = 0; i < 200; ++i) text += "{\"type\": \"sphere\", \"radius\": -1},\n";
  Source source("many.json", text + "{\"type\": \"sphere\", \"radius\": 1}]}");
  const Diagnostics diagnostics = diagnose(source);
  CHECK(diagnostics.print(source, ErrorFormat::Short).starts_with("many.json:2:"));
}

TEST_CASE("nearest", "[source][diagnostics]") {
  const std::vector<std::string_view> words = {"fov", "position", "target", "up", "k"};
  CHECK(nearest("fvo", words) == "fov");
  CHECK(nearest("FOV", words) == "fov");
  CHECK(nearest("positoin", words) == "position");
  CHECK(nearest("posision", words) == "position");
  CHECK(nearest("tagret", words) == "target");
  CHECK(nearest("pu", words) == "up");
  CHECK(nearest("wobble", words) == "");
  const std::string known = std::string(39, 'a') + "b";
  CHECK(nearest(std::string(40, 'a'), {known}) == known);
  // Comparing names as long as the file would take quadratic time.
  CHECK(nearest(std::string(41, 'a'), {known}) == "");
  CHECK(nearest("x", words) == "");
  CHECK(nearest("", words) == "");
  CHECK(nearest("fov", {}) == "");
}

}  // namespace

}  // namespace fathom::diagnostics_test
