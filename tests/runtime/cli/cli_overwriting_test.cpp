// End-to-end tests: no output replaces a file that the command reads, or another output.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::test::cli_overwriting_test {
namespace {

const std::string kLibrary = "fathom 1\ndef ball(r) = sphere(r)\n";
const std::string kScene = R"(fathom 1
import "lib.fathom" as lib
import "inner/model.json" as model
background image(file = "sky.hdr")
camera(position = [0, 0, 5], target = [0, 0, 0])
object lib.ball(1)
object model.scene
)";

}  // namespace

// Only the scene itself was protected: imports and the background's picture were lost.
TEST_CASE("cli: no verb overwrites a file that it reads", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json --size 8x4 -s 1 -q -o sky.hdr").code == 0);
  const std::string sky = folder.read("sky.hdr");
  const std::vector<std::pair<std::string, std::string>> files = {
      {"s.fathom", kScene}, {"lib.fathom", kLibrary}, {"inner/model.json", kBall}, {"sky.hdr", sky}};
  std::filesystem::create_directory(folder.path() / "inner");
  for (const auto& [name, text] : files) folder.write(name, text);
  folder.write("points.txt", "0 0 0\n");
  const Result check = folder.run("check s.fathom");
  INFO(check.err);
  REQUIRE(check.code == 0);
  for (const char* arguments : {
           "render s.fathom --size 8x8 -s 1 -o sky.hdr",
           "render s.fathom --size 8x8 -s 1 -o ./inner/../sky.hdr",
           "render s.fathom --size 8x8 -s 1 -o out.png --stats-json lib.fathom",
           "render s.fathom --size 8x8 -s 1 -o out.png --checkpoint inner/model.json",
           "render s.fathom --size 8x8 -s 1 --frames 0:2 -o f#.png --stats-json lib.fathom",
           "convert s.fathom -o lib.fathom",
           "convert s.fathom -o sky.hdr",
           "import inner/model.json -o inner/model.json",
           "emit cpp s.fathom -o lib.fathom",
           "emit glsl s.fathom -o inner/model.json",
           "emit html s.fathom -o sky.hdr",
           "compile s.fathom -o lib.fathom",
           "report s.fathom -s 1 --size 8x8 -o lib.fathom",
           "report s.fathom -s 1 --size 8x8 --chart sky.hdr -o sky.hdr",
           "plan s.fathom -s 1 --size 8x8 --no-pilot -o sky.hdr",
           "plan s.fathom -s 1 --size 8x8 --no-pilot -o inner/model.json",
       }) {
    const Result result = folder.run(arguments);
    CAPTURE(arguments, result.err);
    CHECK(result.code == 2);
    for (const auto& [name, text] : files) CHECK(folder.read(name) == text);
  }
  CHECK_FALSE(folder.has("out.png"));
  CHECK_FALSE(folder.has("f0.png"));
}

TEST_CASE("cli: the materials of a mesh overwrite nothing", "[cli]") {
  const Folder folder;
  folder.write("s.mtl", kBall);
  CHECK(folder.run("mesh s.mtl --resolution 8 -o s.obj").code == 2);
  CHECK(folder.read("s.mtl") == kBall);
  CHECK_FALSE(folder.has("s.obj"));
}

TEST_CASE("cli: an output's folder is made, but not for a scene with errors", "[cli]") {
  const Folder folder;
  folder.write("bad.json", "{");
  folder.write("move.json", R"({"version": 1, "params": {"time": 0}, "objects": [{"type": "sphere", "radius": "1 + time"}]})");
  CHECK(folder.run("render bad.json -o new/a/b.png").code == 65);
  CHECK_FALSE(folder.has("new"));
  for (const char* arguments :
       {"render ball.json --size 8x8 -s 1 -o 1/a/b.png --stats-json 2/s.json --cost-map 3/c.png",
        "render move.json --size 8x8 -s 1 --frames 0:1 -o 4/f#.png", "slice ball.json -o 5/s.png",
        "convert ball.json -o 6/ball.fathom", "emit cpp ball.json -o 7/ball.h", "compile ball.json -o 8/ball.fbc",
        "mesh ball.json --resolution 8 -o 9/ball.obj", "report ball.json --size 8x8 -s 1 -o 10/r.html",
        "plan ball.json --size 8x8 --no-pilot -o 11/plan.json", "schema -o 12/schema.json",
        "tonemap 1/a/b.png -o 13/b.png"}) {
    const Result result = folder.run(arguments);
    CAPTURE(arguments, result.err);
    CHECK(result.code == 0);
  }
  CHECK(folder.has("1/a/b.png"));
  CHECK(folder.has("4/f0.png"));
  folder.write("file", "");
  const Result result = folder.run("convert ball.json -o file/x/ball.fathom");
  CHECK(result.code == 74);
  CHECK_THAT(result.err, Catch::Contains("file"));
}

// Seven verbs wrote a file named `-`.
TEST_CASE("cli: `-o -` is standard output, or an error", "[cli]") {
  const Folder folder;
  const std::size_t before = folder.files();
  for (const char* arguments : {"convert ball.json", "emit cpp ball.json", "emit glsl ball.json", "emit html ball.json",
                                "report ball.json --size 8x8 -s 1", "schema", "schema --editor vim",
                                "compile ball.json", "render ball.json --size 8x8 -s 1", "slice ball.json"}) {
    const Result result = folder.run(std::string(arguments) + " -o -");
    CAPTURE(arguments, result.err);
    CHECK(result.code == 0);
    CHECK_FALSE(result.out.empty());
  }
  for (const char* arguments :
       {"plan ball.json --no-pilot", "chart ball.json", "schema --editor vscode", "mesh ball.json"}) {
    CAPTURE(arguments);
    CHECK(folder.run(std::string(arguments) + " -o -").code == 2);
  }
  CHECK(folder.files() == before);
}

}  // namespace fathom::test::cli_overwriting_test
