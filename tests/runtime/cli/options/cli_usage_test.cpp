// The program's command line: errors in it, --help, --version.

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_usage_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

}  // namespace

TEST_CASE("cli: every wrong command line is exit code 2 and says what is wrong", "[cli]") {
  struct Case {
    const char* arguments;
    const char* message;
  };
  const Case cases[] = {
      {"rendr ball.json", "did you mean `fathom render`?"},
      {"frobnicate", "unknown verb `frobnicate`"},
      {"ball.json -o out.png", "did you mean `fathom render ball.json`?"},
      {"--versoin", "did you mean `fathom --version`?"},
      {"help rendr", "did you mean `fathom render`?"},
      {"render", "the scene is missing"},
      {"render ball.json --rr-dept 4", "did you mean `--rr-depth`?"},
      {"render ball.json --sppp=4", "unknown option `--sppp`"},
      {"render ball.json two.json", "unexpected argument `two.json`"},
      {"render ball.json --spp", "--spp: its value is missing"},
      {"render ball.json -o --spp 4", "unexpected argument `4`"},
      {"render ball.json -o --quiet", "--output: its value is missing"},
      {"render ball.json -s many", "--spp: `many` is not a whole number from 1 to"},
      {"render ball.json -s 0", "--spp: `0`"},
      {"render ball.json -s 1.5", "--spp: `1.5`"},
      {"render ball.json -t 0", "--tile: `0`"},
      {"render ball.json -b -1", "--rr-depth: `-1`"},
      {"render ball.json --threads 0", "--threads: `0`"},
      {"render ball.json --seed -1", "--seed: `-1`"},
      {"render ball.json --far 0", "--far: `0` is not a positive number"},
      {"render ball.json -r 0", "--resolution: `0`"},
      {"render ball.json -o out.gif", "valid endings: .png, .jpg, .jpeg, .bmp"},
      {"render ball.json -o out", "`out` does not end in a picture format's name"},
      {"render ball.json --aspect 16", "--aspect: `16` is not a ratio"},
      {"render ball.json --aspect 16:0", "--aspect: `16:0`"},
      {"render ball.json --aspect -4:3", "--aspect: `-4:3`"},
      {"render ball.json --aspect 4:3:2", "--aspect: `4:3:2`"},
      {"render ball.json --aspect 16/9", "write it as 16:9 or 4x3"},
      {"render ball.json --aspect nan:1", "--aspect: `nan:1`"},
      {"render ball.json --aspect 1:100000", "too large"},
      {"render ball.json -f 45", "did you mean `45deg`?"},
      {"render ball.json -f 3.2", "did you mean `3.2deg`?"},
      {"render ball.json --sampler halton", "--sampler: `halton`"},
      {"render ball.json --light-sampling some", "--light-sampling: `some` is not one of mis, nee, bsdf"},
      {"render ball.json --clamp 0", "--clamp: `0` is not a positive number"},
      {"render ball.json --noise-threshold 0 --uniform", "--noise-threshold does not go with --uniform"},
      {"render ball.json -s 7 --noise-threshold 0",
       "--noise-threshold: 7 samples per pixel are too few to share out"},
      {"render ball.json -s 16 --noise-threshold 0 --crop 0,0,4,4", "--crop does not go with --noise-threshold"},
      {"render ball.json --filter sinc", "--filter: `sinc`"},
      {"render ball.json --filter-width 0", "--filter-width: `0` is not a number from 0.01 to 64"},
      {"render ball.json -f 0", "--fov: `0` is not between 0 and 180 degrees"},
      {"render ball.json -f 180deg", "--fov: `180deg` is not between 0 and 180 degrees"},
      {"render ball.json -f -1", "--fov: `-1`"},
      {"render ball.json -f wide", "--fov: `wide` is not an angle"},
      {"render ball.json --size 12", "write it as 1920x1080"},
      {"render ball.json --size 12x0", "--size: `12x0`"},
      {"render ball.json --size 4x4 -r 5", "--size gives width and height"},
      {"render ball.json --quiet -v", "--quiet does not go with --verbose"},
      {"check ball.json -D", "--define: its value is missing"},
      {"check ball.json -D radius", "--define: `radius` is not a name and a value"},
      {"check ball.json -D =1", "--define: `=1` is not a name and a value"},
      {"check ball.json -D radius=", "--define: ``: an empty formula"},
      {"check ball.json -D radius=1+", "--define: `1+`: the formula ends too early"},
      {"check ball.json -D radius=wide", "--define: `wide`: unknown name `wide`"},
      {"check ball.json --error-format xml", "--error-format: `xml` is not one of text, short, json"},
      {"dump ball.json --stage bytcode", "did you mean `bytecode`?"},
      {"dump ball.json --after nonsense", "is not one of graph, "},
      {"dump ball.json --stage graph --stats", "--stats is about bytecode"},
      {"dump ball.json --stage syntax --program surface", "--program is about bytecode"},
      {"dump ball.json --stage syntax --after graph", "--after names a pass"},
      {"dump ball.json --format xml", "is not one of text, json, dot, mermaid"},
      {"dump ball.json --stage bytecode --format dot", "bytecode is a sequence, not a graph to draw"},
      {"dump ball.json --program surface --format mermaid", "bytecode is a sequence"},
      {"dump ball.json --stage syntax --format json", "the syntax is printed as text only"},
      {"dump ball.json --stats --format json", "--stats is text"},
      {"dump ball.json --diff --format dot", "--diff is text"},
      {"dump ball.json --diff --stats", "--diff of one scene compares graphs"},
      {"dump ball.json --diff --stage bytecode", "--diff of one scene compares graphs"},
      {"eval ball.json", "no point to evaluate at"},
      {"eval ball.json --at 1,2", "--at: `1,2` is not a point"},
      {"eval ball.json --at 1,2,x", "--at: `1,2,x` is not a point"},
      {"eval ball.json --box 1,0,0,0,1,1", "the first corner's x is above the second's"},
      {"eval ball.json --box 0,0,0,1,1,1 --number f32", "--box needs --number range"},
      {"eval - --points -", "cannot both come from standard input"},
      {"slice", "the scene is missing"},
      {"slice ball.json -o out.gif", "valid endings: .png, .jpg, .jpeg, .bmp"},
      {"slice ball.json --axis w", "--axis: `w` is not one of x, y, z"},
      {"slice ball.json --at high", "--at: `high` is not a number"},
      {"slice ball.json --size 12", "write it as 1920x1080"},
      {"slice ball.json --size 65535x65535", "too large"},
      {"slice ball.json --box 0,0,1", "write its two corners"},
      {"slice ball.json --box 0,1,1,0", "the corner with the smaller coordinates first"},
      {"slice ball.json --show sing", "did you mean `sign`?"},
      {"slice ball.json --threads 0", "--threads: `0`"},
      {"schema ball.json", "unexpected argument `ball.json`"},
  };
  const Folder folder;
  for (const Case& c : cases) {
    INFO("fathom " << c.arguments);
    const Result result = folder.run(c.arguments);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains(c.message) && Contains("error: "));
    CHECK(result.out == "");
  }
  CHECK(folder.files() == 2);  // the scenes, and no images
}

TEST_CASE("cli: help and version go to stdout and succeed", "[cli]") {
  const Folder folder;
  for (const char* arguments : {"--help", "-h", "help"}) {
    const Result result = folder.run(arguments);
    CHECK(result.code == 0);
    CHECK_THAT(result.out, Contains("fathom render scene.fathom") && Contains("Exit status") && Contains("65"));
    CHECK(result.err == "");
  }
  for (const std::string verb : {"render", "check", "dump", "eval", "slice", "schema"}) {
    const Result result = folder.run(verb + " --help");
    CHECK(result.code == 0);
    CHECK_THAT(result.out, Contains("Examples:\n  fathom " + verb));
    CHECK(folder.run("help " + verb).out == result.out);
  }
  const Result nothing = folder.run("");
  CHECK(nothing.code == 2);
  CHECK_THAT(nothing.err, Contains("Usage:"));
  CHECK(nothing.out == "");
}

TEST_CASE("cli: render --help names every flag of the paper", "[cli]") {
  const std::string help = Folder().run("render -h").out;
  for (const char* names :
       {"-h,--help", "-v,", "--aspect", "-a,--albedo", "-d,--depth", "-n,--normal", "-o,--output",
        "-r,--res,--resolution", "-b,--rr-depth", "-f,--fov", "--no-denoise", "-s,--spp", "-t,--tile"}) {
    CHECK_THAT(help, Contains(names));
  }
}

TEST_CASE("cli: the version is the project's", "[cli]") {
  std::stringstream lists;
  lists << std::ifstream(FATHOM_SOURCE_DIR "/CMakeLists.txt").rdbuf();
  const Result result = Folder().run("--version");
  REQUIRE(result.out.substr(0, 7) == "fathom ");
  CHECK_THAT(lists.str(), Contains("VERSION " + result.out.substr(7, result.out.find_first_of(" \n", 7) - 7) + " "));
}

}  // namespace fathom::cli_usage_test
