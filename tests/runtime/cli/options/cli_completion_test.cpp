// Files generated from the option tables: completion scripts and the manual page.

#include "tests/support/catch.h"
#include "tests/support/not_run.h"
#include "tests/support/program.h"

namespace fathom::cli_completion_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::not_run;
using fathom::test::Result;

bool has_program(const std::string& name) {
  return Folder().run_script("command -v " + name + " >found").code == 0;
}

}  // namespace

TEST_CASE("cli: bash completes verbs, options and their values", "[cli]") {
  if (!has_program("bash")) return not_run("bash is missing");
  const Folder folder;
  const Result result = folder.run_script(R"(
    $fathom completion bash >fathom.bash || exit 3
    bash -n fathom.bash || exit 4
    cat >asked.bash <<'END'
source ./fathom.bash
complete -p fathom >/dev/null || exit 5
# The words of the line, of which the last is completed, as bash splits them.
ask() {
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  _fathom
  echo "${COMPREPLY[*]}"
}
ask fathom ren
ask fathom com
ask fathom render --sp
ask fathom render ball.json -
ask fathom render ball.json --tone a
ask fathom render ball.json --tone = ag
ask fathom render ball.json --spp ''
ask fathom render ball.json --spp 4 --resu
ask fathom render b
ask fathom emit c
ask fathom completion ''
ask fathom help lim
ask fathom dump --after canonicalise
END
    bash asked.bash)");
  INFO(result.err);
  REQUIRE(result.code == 0);
  std::istringstream lines(result.out);
  const auto next = [&] {
    std::string line;
    REQUIRE(std::getline(lines, line));
    return line;
  };
  CHECK(next() == "render");
  CHECK(next() == "compile completion");
  CHECK(next() == "--spp");
  CHECK_THAT(next(), Contains("-o --output") && Contains("--sample-range"));
  CHECK(next() == "aces agx");
  CHECK(next() == "agx");
  CHECK(next() == "");  // a number has no completions
  CHECK(next() == "--resume");
  CHECK(next() == "");  // a file name, which bash itself completes
  CHECK(next() == "cpp");
  CHECK(next() == "bash zsh fish");
  CHECK(next() == "limits");
  next();
}

TEST_CASE("cli: the scripts for zsh and fish are ones, and name every option of render", "[cli]") {
  const Folder folder;
  const std::string zsh = folder.run("completion zsh").out, fish = folder.run("completion fish").out;
  CHECK(zsh.starts_with("#compdef fathom\n"));
  CHECK_THAT(zsh, Contains("'render:renders the scene to image files'") && Contains("'*--tone=[") &&
                      Contains(":CURVE:(none filmic aces agx neutral)'") && Contains("'1:scene:_files'") &&
                      Contains("'1:language:(cpp glsl html)'"));
  CHECK_THAT(fish, Contains("complete -c fathom -n '__fish_seen_subcommand_from render' -s s -l spp -x -d ") &&
                       Contains("-l tone -x -a 'none filmic aces agx neutral'"));
  std::istringstream help(folder.run("help render").out);
  for (std::string line; std::getline(help, line);) {
    const std::size_t at = line.find("--");
    if (!line.starts_with("  -") || at == std::string::npos) continue;
    const std::string option = line.substr(at, line.find_first_of(" ,", at) - at);
    INFO(option);
    CHECK_THAT(zsh, Contains("'*" + option + "[") || Contains("'*" + option + "=["));
    CHECK_THAT(fish, Contains(" -l " + option.substr(2) + " "));
  }
}

TEST_CASE("cli: zsh parses its script", "[cli]") {
  if (!has_program("zsh")) return not_run("zsh is missing");
  CHECK(Folder().run_script("$fathom completion zsh >fathom.zsh && zsh -n fathom.zsh").code == 0);
}

TEST_CASE("cli: fish parses its script", "[cli]") {
  if (!has_program("fish")) return not_run("fish is missing");
  CHECK(Folder().run_script("$fathom completion fish >fathom.fish && fish --no-execute fathom.fish").code == 0);
}

TEST_CASE("cli: a shell that is not known is exit code 2", "[cli]") {
  const Result result = Folder().run("completion basch");
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Contains("did you mean `bash`?"));
}

TEST_CASE("cli: the manual page has every verb, option and exit status, and groff has nothing against it", "[cli]") {
  const Folder folder;
  const std::string page = folder.run("man").out;
  CHECK_THAT(page, Contains(".TH FATHOM 1") && Contains(".SH NAME\nfathom \\- ") && Contains(".SH EXIT STATUS"));
  CHECK_THAT(page, Contains(".SS \"fathom render scene.fathom \\-o out.png\"") &&
                       Contains("\\fB\\-s\\fR, \\fB\\-\\-spp\\fR \\fIN\\fR\n"));
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    CHECK(line.find_first_not_of(' ') != std::string::npos);
    if (line.starts_with('.'))
      CHECK((std::isupper(line[1]) || line[1] == '\\' || line[1] == 'b' || line[1] == 'n' || line[1] == 'f'));
  }
  if (!has_program("groff")) return not_run("groff is missing");
  folder.write("fathom.1", page);
  CHECK(folder.run_script("groff -man -Tutf8 -ww fathom.1 2>&1 >page").out == "");
}

TEST_CASE("cli: mandoc has nothing against the manual page", "[cli]") {
  if (!has_program("mandoc")) return not_run("mandoc is missing");
  CHECK(Folder().run_script("$fathom man >fathom.1 && mandoc -T lint -W error fathom.1").code == 0);
}

}  // namespace fathom::cli_completion_test
