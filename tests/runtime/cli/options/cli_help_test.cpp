// Help of every verb: as wide as the terminal, and about the options that exist.
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/cli/run.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_help_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

// Returns the second word of the lines "  fathom VERB ..." of the overview.
std::set<std::string> verbs() {
  std::set<std::string> names;
  std::istringstream help(Folder().run("--help").out);
  for (std::string line; std::getline(help, line);) {
    std::istringstream words(line);
    std::string program, verb;
    if (line.starts_with("  fathom ") && words >> program >> verb && verb != "help" && !verb.starts_with('-')) {
      names.insert(verb);
    }
  }
  return names;
}

std::string longest_line(const std::string& text) {
  std::string longest;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() > longest.size()) longest = line;  // bytes are columns, because help is ASCII
  }
  return longest;
}

}  // namespace

// Regression: help printed lines of 200 characters and more on any terminal.
TEST_CASE("cli: help has no line wider than the terminal", "[cli]") {
  std::set<std::string> names = verbs();
  REQUIRE(names.size() >= 14);
  names.insert("limits");
  for (const int columns : {60, 80, 120}) {
    std::istringstream in;
    std::ostringstream out, err;
    const cli::Streams streams{.in = in, .out = out, .err = err, .columns = columns};
    CHECK(cli::run(std::vector<std::string>{"--help"}, streams) == 0);
    for (const std::string& name : names) CHECK(cli::run(std::vector<std::string>{"help", name}, streams) == 0);
    CHECK_THAT(out.str(), Contains("--sample-range"));
    const std::string longest = longest_line(out.str());
    INFO(columns << ": " << longest);
    CHECK(longest.size() <= static_cast<std::size_t>(columns));
    CHECK(longest.size() > static_cast<std::size_t>(columns) - 10);
  }
}

TEST_CASE("cli: help is as wide as COLUMNS says", "[cli]") {
  for (const char* columns : {"60", "120"}) {
    const Result result = Folder().run_script("COLUMNS=" + std::string(columns) + " $fathom help render");
    CHECK(longest_line(result.out).size() <= std::stoul(columns));
    CHECK(longest_line(result.out).size() > std::stoul(columns) - 10);
  }
}

TEST_CASE("cli: help is 80 columns wide without a terminal, and COLUMNS that is no number says nothing", "[cli]") {
  const Folder folder;
  for (const char* variable : {"unset COLUMNS", "COLUMNS=wide; export COLUMNS", "COLUMNS=0; export COLUMNS"}) {
    INFO(variable);
    const Result result = folder.run_script(std::string(variable) + "; $fathom help render");
    CHECK(longest_line(result.out).size() <= 80);
    CHECK(longest_line(result.out).size() > 76);
  }
}

TEST_CASE("cli: an example that is too wide becomes lines that a shell joins", "[cli]") {
  const Folder folder;
  const std::string help = folder.run_script("COLUMNS=40; export COLUMNS; $fathom help render").out;
  CHECK_THAT(help,
             Contains("  # and out-albedo.png, ...\n  fathom render scene.fathom -o \\\n      out.png -a -d -n\n"));
}

TEST_CASE("cli: -V and --version print version, commit and instruction set", "[cli]") {
  const Folder folder;
  const Result result = folder.run("-V");
  CHECK(result.code == 0);
  CHECK(result.out.starts_with("fathom "));
  CHECK(folder.run("--version").out == result.out);
  CHECK_THAT(folder.run_script("FATHOM_ISA=scalar $fathom -V").out,
             Contains("\ninstruction set scalar, compiled by "));
}

}  // namespace fathom::cli_help_test
