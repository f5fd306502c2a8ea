// Files for editors: generated from the language's words, and able to parse the program's messages.
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "compiler/frontend/text/parse/vocabulary.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_editor_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

}  // namespace

TEST_CASE("cli: schema writes what editors read", "[cli]") {
  const Folder folder;
  const Result vim = folder.run("schema --editor vim");
  CHECK(vim.code == 0);
  for (const std::string_view word : compiler::text::all_words()) {
    CHECK_THAT(vim.out, Contains("/\\<" + std::string(word) + "\\ze\\s*(/\n"));
  }
  CHECK(folder.run("schema --editor vscode").code == 2);
  CHECK(folder.run("schema --editor ed").code == 2);
  CHECK(folder.run("schema --editor vscode -o code").code == 0);
  const auto package = nlohmann::json::parse(folder.read("code/package.json"));
  const auto grammar = nlohmann::json::parse(folder.read("code/syntaxes/fathom.tmLanguage.json"));
  CHECK(nlohmann::json::parse(folder.read("code/language-configuration.json"))["comments"]["lineComment"] == "//");
  CHECK(package["contributes"]["languages"][0]["extensions"][0] == ".fathom");
  CHECK_THAT(grammar.dump(), Contains("smooth_union|"));
}

TEST_CASE("cli: the problem matcher reads the short form of errors", "[cli]") {
  const Folder folder;
  folder.run("schema --editor vscode -o code");
  const auto matcher =
      nlohmann::json::parse(folder.read("code/package.json"))["contributes"]["problemMatchers"][0]["pattern"];
  folder.write("a.fathom", "fathom 1\nlet red = diffuse(colour = 0.5)\nobject sphere(1, raduis = 2).material(red)\n");
  std::istringstream lines(folder.run("check --error-format short a.fathom").err);
  const std::regex pattern(matcher["regexp"].get<std::string>());
  int problems = 0;
  for (std::string line; std::getline(lines, line); ++problems) {
    std::smatch match;
    INFO(line);
    REQUIRE(std::regex_match(line, match, pattern));
    CHECK(match[matcher["file"]].str() == "a.fathom");
    CHECK(match[matcher["severity"]].str() == "error");
    CHECK(match[matcher["code"]].str() == "E0102");
  }
  CHECK(problems == 2);
}

}  // namespace fathom::cli_editor_test
