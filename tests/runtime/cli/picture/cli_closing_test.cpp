// The lines that a render prints at its end.
#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_closing_test {

namespace {

using Catch::Contains;
using Catch::Matches;
using fathom::test::Folder;
using fathom::test::Result;

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

// Regression: a render printed 25 lines, most of them zeros, before the name of the file.
TEST_CASE("cli: a render closes with four lines, and -v with all counts before them", "[cli]") {
  const Folder folder;
  const Result plain = folder.run("render ball.json -o a.png");
  CHECK(lines(plain.err) == 4);
  CHECK_THAT(plain.err, Matches("drew ball.json: 32x16 pixels, 2 samples per pixel\n"
                                "rays: [0-9]+, [0-9.]+ % of them hit.*\n"
                                "time: [0-9.e-]+ s on [0-9]+ threads?, [0-9.]+ million rays per second.*\n"
                                "wrote a.png \\(32x16\\)\n"));
  const Result all = folder.run("render ball.json -o a.png -v");
  CHECK_THAT(all.err, Contains("camera rays") && Contains("lanes that held a ray") && Contains("ended by"));
  CHECK(lines(all.err) > 25);
  CHECK_THAT(folder.run("render ball.json -o a.png --profile").err,
             Contains("seconds of march") && Contains("evaluations per ray"));
}

TEST_CASE("cli: the closing lines say what part was drawn, and by how many samples", "[cli]") {
  const Folder folder;
  CHECK_THAT(folder.run("render ball.json -o a.png --crop 0,0,8,4 -s 1").err,
             Contains("drew ball.json: 8x4 pixels of 32x16, 1 sample per pixel\n"));
  CHECK_THAT(folder.run("render ball.json -o a.png -s 64 --noise-threshold 1000").err,
             Contains(", ended by noise below limit\n"));
}

TEST_CASE("cli: --watch prints one line per picture", "[cli]") {
  const Folder folder;
  const Result result = folder.run_script(R"(
    wait_for() { for i in $(seq 2400); do if eval "$1"; then return 0; fi; sleep 0.05; done; exit 9; }
    "$fathom" render ball.json --watch 2>log & watcher=$!
    trap 'kill $watcher' EXIT
    wait_for 'grep -q drawing log'
    sed 's/0.5/0.6/' ball.json >b && mv b ball.json
    wait_for 'test $(grep -c drew log) -ge 2'
    trap - EXIT
    kill -TERM $watcher
    wait $watcher
    test $? = 143)");
  INFO(folder.read("log"));
  CHECK(result.code == 0);
  const std::string log = folder.read("log");
  CHECK(lines(log) == 4);
  CHECK_THAT(log,
             Matches("note: the picture goes to ball.png; -o FILE chooses another name\n"
                     "drew ball.json: 32x16 pixels, 2 samples per pixel, [0-9.e-]+ s, wrote ball.png \\(32x16\\)\n"
                     "note: drawing again whenever ball.json changes; Ctrl-C ends\n"
                     "drew .*\n"));
}

}  // namespace fathom::cli_closing_test
