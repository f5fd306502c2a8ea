// `fathom merge`: the merged parts of a render equal the whole render bit for bit, however the render was split.
// Parts that do not fit are refused.
#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_merge_test {

namespace {

using namespace fathom::test;
using Catch::Contains;

TEST_CASE("cli merge: crops and sample ranges split at random are the whole render, with cmp", "[cli]") {
  const Folder folder;
  for (unsigned seed = 0; seed < 3; ++seed) {
    std::mt19937 random(seed);
    const auto between = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); };
    REQUIRE(folder.run("render ball.json -s 9 -q -o whole.exr -o whole.film -o whole.png").code == 0);
    const int x = between(1, 31), y = between(1, 15), s = between(1, 8);
    std::vector<std::string> parts;
    for (const std::string& area :
         {"0,0," + std::to_string(x) + ",16", std::to_string(x) + ",0,32," + std::to_string(y),
          std::to_string(x) + "," + std::to_string(y) + ",32,16"}) {
      for (const std::string& range : {"0:" + std::to_string(s), std::to_string(s) + ":9"}) {
        const std::string name = "part" + std::to_string(parts.size()) + ".film";
        REQUIRE(folder
                    .run("render ball.json -s 9 -q -o " + name + " --crop " + area + " --sample-range " + range +
                         " --threads " + std::to_string(between(1, 3)) + " -t " + std::to_string(between(1, 20)))
                    .code == 0);
        parts.push_back(name);
      }
    }
    std::shuffle(parts.begin(), parts.end(), random);
    std::string names;
    for (const std::string& part : parts) names += part + " ";
    const Result merged = folder.run("merge " + names + "-o m.exr -o m.film -o m.png");
    INFO(names << merged.err);
    CHECK(merged.code == 0);
    CHECK_THAT(merged.err, !Contains("not all of it"));
    CHECK(folder.read("m.exr") == folder.read("whole.exr"));
    CHECK(folder.read("m.film") == folder.read("whole.film"));
    CHECK(folder.read("m.png") == folder.read("whole.png"));
    // Merges in two steps.
    REQUIRE(folder.run("merge " + parts[0] + " " + parts[1] + " -q -o some.film").code == 0);
    names = "some.film";
    for (std::size_t i = 2; i < parts.size(); ++i) names += " " + parts[i];
    REQUIRE(folder.run("merge " + names + " -o m.film").code == 0);
    CHECK(folder.read("m.film") == folder.read("whole.film"));
  }
}

TEST_CASE("cli merge: a part of the samples is a render of those, weighted by how many there are", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -s 8 -q -o a.film --sample-range 0:2").code == 0);
  REQUIRE(folder.run("render ball.json -s 8 -q -o b.film --sample-range 2:5").code == 0);
  REQUIRE(folder.run("render ball.json -s 8 -q -o ab.exr --sample-range 0:5").code == 0);
  CHECK(folder.run("merge b.film a.film -o m.exr").code == 0);
  CHECK(folder.read("m.exr") == folder.read("ab.exr"));
  REQUIRE(folder.run("render ball.json -s 8 -q -o c.film --sample-range 7:8 --crop 0,0,32,8").code == 0);
  const Result holes = folder.run("merge c.film a.film b.film -o m.exr");
  CHECK(holes.code == 0);
  CHECK_THAT(holes.err, Contains("there are no samples"));
}

TEST_CASE("cli merge: parts of a scene and of its compiled file go together", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile ball.json -o ball.fbc").code == 0);
  REQUIRE(folder.run("render ball.json -s 8 -q -o a.film --sample-range 0:2").code == 0);
  REQUIRE(folder.run("render ball.fbc -s 8 -q -o b.film --sample-range 2:8").code == 0);
  REQUIRE(folder.run("render ball.json -s 8 -q -o whole.exr").code == 0);
  const Result merged = folder.run("merge a.film b.film -o m.exr");
  INFO(merged.err);
  CHECK(merged.code == 0);
  CHECK(folder.read("m.exr") == folder.read("whole.exr"));
}

TEST_CASE("cli merge: doubled samples and other renders are refused by name", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -s 8 -q -o a.film --sample-range 0:5").code == 0);
  REQUIRE(folder.run("render ball.json -s 8 -q -o b.film --sample-range 4:8 --crop 8,4,20,9").code == 0);
  const Result twice = folder.run("merge a.film b.film -o m.exr");
  CHECK(twice.code == 65);
  CHECK_THAT(twice.err, Contains("`a.film` and `b.film` both have samples 4:5 of the pixels 8,4,20,9"));
  CHECK(folder.run("merge a.film a.film -o m.exr").code == 65);
  REQUIRE(folder.run("render ball.json -s 9 -q -o c.film --sample-range 5:8").code == 0);
  CHECK_THAT(folder.run("merge a.film c.film -o m.exr").err,
             Contains("spp is 8 in `a.film` and 9 in `c.film`") && Contains("leave one out"));
  REQUIRE(folder.run("render two.json -s 8 -q -o d.film --size 32x16 --sample-range 5:8").code == 0);
  const Result other = folder.run("merge a.film d.film -o m.exr");
  CHECK(other.code == 65);
  CHECK_THAT(other.err, Contains("different renders") && Contains("scene is ") && Contains("program is "));
  REQUIRE(folder.run("render ball.json -s 8 -q -o e.film --noise-threshold 0").code == 0);
  CHECK(folder.run("merge a.film e.film -o m.exr").code == 65);
  REQUIRE(folder.run("render ball.json -s 8 -q -o e.exr --noise-threshold 0").code == 0);
  CHECK(folder.run("merge e.film -o m.exr").code == 0);  // but e.film alone can become an image
  CHECK(folder.read("m.exr") == folder.read("e.exr"));
  CHECK_FALSE(folder.has("out.png"));
}

// Two small films can be far apart: their sum is as large as the whole image.
TEST_CASE("cli merge: the sum takes no more memory than is allowed", "[cli]") {
  const Folder folder;
  const std::string render = "render ball.json -s 1 -q --size 400x300 ";
  REQUIRE(folder.run(render + "-o a.film --crop 0,0,1,1").code == 0);
  REQUIRE(folder.run(render + "-o b.film --crop 399,299,400,300").code == 0);
  const Result refused = folder.run("merge a.film b.film -o m.png --limit memory=1e6");
  CHECK(refused.code == 65);
  CHECK_THAT(refused.err, Contains("400x300 pixels") && Contains("--limit memory="));
  CHECK_FALSE(folder.has("m.png"));
  CHECK(folder.run("merge a.film b.film -o m.png --limit memory=1e8").code == 0);
  CHECK(folder.run("merge a.film -o m.png --limit memory=3e4").code == 0);
  REQUIRE(folder.run(render + "-o whole.film").code == 0);
  CHECK(folder.run("merge whole.film -o m.png --limit memory=1e6").code == 65);
}

TEST_CASE("cli merge: what is full only together is said to be lost", "[cli]") {
  const Folder folder;
  folder.write("bright.json", R"({"version": 1, "camera": {"position": [0, 0, 4], "target": [0, 0, 0]},
      "film": {"width": 4, "height": 4}, "background": [4e8, 4e8, 4e8], "objects": [{"type": "sphere", "radius": 0.1}]})");
  const Result first = folder.run("render bright.json -s 8 -q -o a.film --sample-range 0:4");
  CHECK_THAT(first.err, !Contains("lost"));
  REQUIRE(folder.run("render bright.json -s 8 -q -o b.film --sample-range 4:8").code == 0);
  const Result merged = folder.run("merge a.film b.film -o m.exr");
  CHECK(merged.code == 0);
  CHECK_THAT(merged.err, Contains("warning: samples of `b.film` lost"));
  CHECK_THAT(folder.run("render bright.json -s 8 -q -o m.exr").err, Contains("samples lost"));
}

// Regression: light of 1e-10 was black without a warning.
TEST_CASE("cli merge: light too faint for the film is said to be", "[cli]") {
  const Folder folder;
  const auto render = [&](const std::string& background) {
    folder.write("faint.json", R"({"version": 1, "camera": {"position": [0, 0, 4], "target": [0, 0, 0]},
        "film": {"width": 4, "height": 4}, "background": )" +
                                   background + R"(, "objects": [{"type": "sphere", "radius": 0.1}]})");
    return folder.run("render faint.json -s 8 -q -o m.exr").err;
  };
  CHECK_THAT(render("[1e-10, 1e-10, 1e-10]"),
             Contains("warning: 128 of 128 samples with light are too faint for the film"));
  CHECK_THAT(render("[1e-9, 1e-9, 1e-9]"), Contains("too faint for the film"));
  CHECK_THAT(render("[1e-7, 1e-7, 1e-7]"), !Contains("too faint"));
  CHECK_THAT(render("[0, 0, 0]"), !Contains("too faint"));
  // In an otherwise bright image, faint light is invisible and needs no warning.
  CHECK_THAT(render(R"({"bottom": [0, 0, 1e-12], "top": [1, 1, 1]})"), !Contains("too faint"));
}

TEST_CASE("cli merge: usage, files that are none, and outputs in the way", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -s 2 -q -o a.film").code == 0);
  CHECK(folder.run("merge -o m.exr").code == 2);
  CHECK(folder.run("merge a.film").code == 2);
  CHECK(folder.run("merge a.film -o a.film").code == 2);
  CHECK(folder.run("merge a.film -o m.gif").code == 2);
  CHECK(folder.run("merge missing.film -o m.exr").code == 74);
  CHECK(folder.run("merge ball.json -o m.exr").code == 65);
  CHECK(folder.run("merge a.film -o a.film/m.exr").code == 74);
  CHECK(folder.run("merge a.film -o m.png --exposure 1 --tone agx --bits 16").code == 0);
  CHECK(folder.run("merge a.film -o m.png --denoise").code == 65);
  for (const char* wrong : {"5", "3:2", "2:2", "-1:2", "1:99", "a:b"}) {
    CHECK(folder.run(std::string("render ball.json -s 4 -o b.film --sample-range ") + wrong).code == 2);
  }
  CHECK(folder.run("render ball.json -s 16 -o b.film --noise-threshold 0 --sample-range 0:8").code == 2);
}

}  // namespace

}  // namespace fathom::cli_merge_test
