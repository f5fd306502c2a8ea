// End-to-end tests of models in other formats.

#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/program.h"

namespace fathom::cli_import_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

const char* const kCircle =
    "# a circle\nx var-x\ny var-y\na square x\nb square y\nc add a b\nd sqrt c\nr const 0.5\ne sub d r\n";
const char* const kTwoBalls = R"({
  "aabb_min": [-1, -1, -1], "aabb_max": [1, 1, 1],
  "nodeType": "binaryOperator", "blendMode": "union", "blendRadius": 0.2, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
  "leftChild": {"nodeType": "primitive", "primitiveType": "sphere", "radius": 0.5, "color": [1, 0, 0], "round_x": 0,
                "round_y": 0, "matrix": [1, 0, 0, 0.4, 0, 1, 0, 0, 0, 0, 1, 0]},
  "rightChild": {"nodeType": "primitive", "primitiveType": "sphere", "radius": 0.5, "color": [0, 0, 1], "round_x": 0,
                 "round_y": 0, "matrix": [1, 0, 0, -0.4, 0, 1, 0, 0, 0, 0, 1, 0]}
})";

std::string data(const std::string& name) { return "'" FATHOM_SOURCE_DIR "/tests/data/" + name + "'"; }

}  // namespace

TEST_CASE("cli: every verb reads the other formats, from files of any name and from standard input", "[cli]") {
  const Folder folder;
  folder.write("circle.vm", kCircle);
  folder.write("balls", kTwoBalls);
  for (const std::string name : {"circle.vm", "balls"}) {
    CAPTURE(name);
    CHECK_THAT(folder.run("check " + name).out, Contains(name + ": no errors"));
    CHECK(folder.run("dump " + name).code == 0);
    CHECK(folder.run("dump --stage syntax " + name).out.starts_with("version: 1\n"));
    CHECK(folder.run("render " + name + " -o a.png -s 1 --size 16x16").code == 0);
    CHECK(folder.run("slice " + name + " -o a.png --size 8x8").code == 0);
    CHECK(folder.run("check - ", folder.read(name)).code == 0);
  }
  CHECK(folder.run("eval circle.vm --at 0,0.75,0").out == "0.25 0 1 0 expression\n");
  // The node's matrix maps points into the node's space: the red ball, with +0.4, is on the left.
  CHECK(folder.run("eval balls --at -2,0,0").out.starts_with("1.1 -1 0 0 "));
}

TEST_CASE("cli: import writes a scene that means the same", "[cli]") {
  const Folder folder;
  folder.write("circle.vm", kCircle);
  folder.write("balls.json", kTwoBalls);
  const std::string at = " --at 0.1,0.2,0 --at 0.9,-0.7,0.3 --at -2,1,0.5";
  for (const std::string name : {"circle.vm", "balls.json"}) {
    CAPTURE(name);
    const Result result = folder.run("import --bare " + name + " -o scene.json");
    CHECK(result.code == 0);
    CHECK(result.out.empty());
    CHECK(result.err.ends_with("wrote scene.json\n"));
    CHECK(folder.read("scene.json").starts_with("// From `" + name + "`.\n{\n  \"version\": 1,\n"));
    CHECK(folder.run("eval scene.json" + at).out == folder.run("eval " + name + at).out);
    CHECK(folder.run("import --bare " + name).out == folder.read("scene.json"));
  }
}

TEST_CASE("cli: a model is drawn as the scene that import writes of it, on a ground and lit", "[cli]") {
  const Folder folder;
  folder.write("balls", kTwoBalls);
  CHECK(folder.run("import balls -o scene.json").code == 0);
  CHECK_THAT(folder.read("scene.json"),
             Contains("\"ground\"") && Contains("\"directional\"") && !Contains("\"camera\""));
  CHECK(folder.run("render balls -o a.pfm -s 1 --size 32x18").code == 0);
  CHECK(folder.run("render scene.json -o b.pfm -s 1 --size 32x18").code == 0);
  CHECK(folder.read("a.pfm") == folder.read("b.pfm"));
  // Verbs that evaluate the model alone do not see the added ground. A compiled file of the model has no ground
  // either.
  CHECK_THAT(folder.run("eval balls --at 40,-0.5,0").out, !Contains("ground"));
  CHECK_THAT(folder.run("eval scene.json --at 40,-0.5,0").out, Contains("ground"));
  CHECK(folder.run("compile balls -o balls.fbc").code == 0);
  const Result stored = folder.run("render balls.fbc -o a.pfm -s 1 --size 32x18");
  CHECK(stored.code == 0);
  CHECK_THAT(stored.err, !Contains("other programs"));
}

TEST_CASE("cli: import refuses scenes, mistakes, and its own input as output", "[cli]") {
  const Folder folder;
  folder.write("circle.vm", kCircle);
  folder.write("bad.vm", "x var-x\ny add x z\n");
  const Result scene = folder.run("import ball.json");
  CHECK(scene.code == 2);
  CHECK_THAT(scene.err, Contains("`ball.json` is a scene file already"));
  const Result bad = folder.run("import bad.vm -o out.json");
  CHECK(bad.code == folder.run("dump bad.vm").code);
  CHECK_THAT(bad.err, Contains("bad.vm:2:9") && Contains("`z` has no value here"));
  CHECK(!folder.has("out.json"));
  CHECK(folder.run("import circle.vm -o ./circle.vm").code == 2);
  CHECK(folder.read("circle.vm") == kCircle);
  CHECK_THAT(folder.run("import circle.vm -o circle.vm/out.json").err, Contains("cannot write to the folder `circle.vm`"));
}

TEST_CASE("cli: prospero's pixels", "[cli]") {
  const Folder folder;
  const Result result =
      folder.run("slice " + data("prospero.vm") + " -o a.png --show sign --size 1024x1024 --box -1,-1,1,1");
  CHECK(result.out == "inside 132816 of 1048576 pixels\n");
}

}  // namespace fathom::cli_import_test
