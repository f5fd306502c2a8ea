// End-to-end tests of cameras with a shutter.
#include <string>

#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/scaled_cases.h"

namespace fathom::cli_shutter_test {
namespace {

using namespace fathom::test;
using Catch::Contains;

const char* const kFast = R"({
  "version": 1,
  "params": {"time": 0},
  "film": {"width": 32, "height": 16, "fps": 10},
  "render": {"spp": 16},
  "camera": {"position": [0, 0, 4], "shutter": 0.5},
  "background": {"bottom": [0.2, 0.2, 0.2], "top": [1, 1, 1]},
  "objects": [{"type": "sphere", "radius": 0.5, "translate": ["10*time", 0, 0]}]
})";

class Moving : public Folder {
 public:
  Moving() {
    write("fast.json", kFast);
    std::string still = kFast;
    still.replace(still.find(", \"shutter\": 0.5"), 16, "");
    write("still.json", still);
  }
};

TEST_CASE("cli shutter: a still with a time blurs at its time, as the frame of that time does", "[cli]") {
  const Moving folder;
  REQUIRE(folder.run("render fast.json -D time=0.1 -o fast.exr -q").code == 0);
  REQUIRE(folder.run("render still.json -D time=0.1 -o still.exr -q").code == 0);
  CHECK((folder.read("fast.exr") != folder.read("still.exr")));
  REQUIRE(folder.run("render fast.json --frames 1 --fixed-noise -o frame.exr -q").code == 0);
  CHECK((folder.read("frame-0001.exr") == folder.read("fast.exr")));
  REQUIRE(folder.run("render fast.json --frames 1 -o other.exr -q").code == 0);
  CHECK((folder.read("other-0001.exr") != folder.read("fast.exr")));
  // The ball moves during half a frame: by 0.5, its centre from 1 to 1.5.
  REQUIRE(folder.run("diff still.exr fast.exr -q").code == 0);
  REQUIRE(folder.run("render fast.json -D time=0.1 --fps 1000000 -o short.exr -q").code == 0);
  CHECK(folder.run("diff short.exr still.exr --metric mse --tol 1e-3 -q").code == 0);
  CHECK(folder.run("diff fast.exr still.exr --metric mse --tol 1e-3 -q").code == 1);
}

TEST_CASE("cli shutter: threads, tiles, parts and resumes leave no trace", "[cli]") {
  const Moving folder;
  REQUIRE(folder.run("render fast.json -o whole.exr -q --shutter-times 5").code == 0);
  REQUIRE(folder.run("render fast.json -o a.exr -q --shutter-times 5 --threads 3 -t 3").code == 0);
  CHECK((folder.read("a.exr") == folder.read("whole.exr")));
  for (const char* range : {"0:5", "5:12", "12:16"}) {
    REQUIRE(folder
                .run("render fast.json -q --shutter-times 5 --sample-range " + std::string(range) + " -o " +
                     range[0] + ".film")
                .code == 0);
  }
  REQUIRE(folder.run("merge 5.film 0.film 1.film -o sum.exr -q").code == 0);
  CHECK((folder.read("sum.exr") == folder.read("whole.exr")));
  // Films with different moments belong to different renders.
  REQUIRE(folder.run("render fast.json -q --shutter-times 4 --sample-range 0:5 -o four.film").code == 0);
  const Result other = folder.run("merge four.film 5.film -o sum.exr");
  CHECK(other.code == 65);
  CHECK_THAT(other.err, Contains("shutter times is 4 in `four.film` and 5 in `5.film`"));
  REQUIRE(folder.run("render fast.json -q --shutter-times 5 --fps 11 --sample-range 0:5 -o late.film").code == 0);
  CHECK_THAT(folder.run("merge late.film 5.film -o sum.exr").err, Contains("moments is "));
  REQUIRE(folder.run("render still.json -q --sample-range 0:5 -o still.film").code == 0);
  CHECK(folder.run("merge still.film 5.film -o sum.exr").code == 65);
}

TEST_CASE("cli shutter: kill -9 and resume give the bits of a render that was not disturbed", "[cli]") {
  const Moving folder;
  const std::string render =
      "fast.json --denoise --shutter-times 8 -q -s " + std::to_string(fathom::test::scaled_cases(1600));
  REQUIRE(folder.run("render " + render + " -o whole.exr").code == 0);
  const Result result =
      folder.run_script("for s in 0.05 0.1 0.15 0.2; do\n  timeout -s KILL $s \"$fathom\" render " + render +
                        " -o a.exr --resume --checkpoint-interval 0.01s 2>/dev/null\ndone\n\"$fathom\" render " +
                        render + " -o a.exr --resume\necho $?");
  INFO(result.err);
  CHECK(result.out == "0\n");
  CHECK((folder.read("a.exr") == folder.read("whole.exr")));
}

TEST_CASE("cli shutter: the camera may be what moves, and is one with the command line's", "[cli]") {
  const Moving folder;
  folder.write("pan.fathom", R"(fathom 1
param time = 0
film (width = 32, height = 16)
camera (position = [6*time, 0, 4], target = [6*time, 0, 0], shutter = 1)
background [1, 1, 1]
object sphere(0.5)
)");
  REQUIRE(folder.run("render pan.fathom -o pan.exr -q").code == 0);
  REQUIRE(folder.run("render pan.fathom --position 0,0,4 --look-at 0,0,0 -o held.exr -q").code == 0);
  CHECK((folder.read("pan.exr") != folder.read("held.exr")));
  // When the command line fixes the camera, nothing moves, and the pixels equal those of a static scene. Only the
  // image's metadata differ.
  folder.write("stands.fathom", R"(fathom 1
film (width = 32, height = 16)
camera (position = [0, 0, 4])
background [1, 1, 1]
object sphere(0.5)
)");
  REQUIRE(folder.run("render stands.fathom -o stands.pfm -q").code == 0);
  REQUIRE(folder.run("render pan.fathom --position 0,0,4 --look-at 0,0,0 -o held.pfm -q").code == 0);
  CHECK((folder.read("stands.pfm") == folder.read("held.pfm")));
}

TEST_CASE("cli shutter: moments of the same programs have their regions together", "[cli]") {
  const Moving folder;
  folder.write("many.fathom", R"(fathom 1
param time = 0
film (width = 96, height = 72, fps = 8)
render (spp = 16)
camera (position = [12*cos(time) + 3, 6, 12*sin(time) + 3], target = [3, 3, 3], shutter = 0.5)
background [1, 1, 1]
object [for i in 0..729: sphere(1).translate([mod(i, 9), mod(floor(i/9), 9), floor(i/81)])]
)");
  REQUIRE(folder.run("render many.fathom -o a.png -q --stats-json stats.json").code == 0);
  CHECK_THAT(folder.read("stats.json"), Contains("\"regions_reused\": 7,"));
  REQUIRE(folder.run("render many.fathom -o b.png -q --no-regions").code == 0);
  CHECK(folder.read("a.png") == folder.read("b.png"));
}

TEST_CASE("cli shutter: far from zero all moments are about one origin", "[cli]") {
  const Moving folder;
  folder.write("far.fathom", R"(fathom 1
param time = 0
film (width = 32, height = 16, fps = 1)
camera (position = [100000 + 60*time, 0, 4], target = [100000 + 60*time, 0, 0], shutter = 1)
background [1, 1, 1]
object sphere(0.5).translate([100000 + 60*time, 0, 0])
)");
  REQUIRE(folder.run("render far.fathom -o far.exr -q").code == 0);
}

TEST_CASE("cli shutter: what takes no part of the moments is refused", "[cli]") {
  const Moving folder;
  const Result result = folder.run("render fast.json -o a.png --noise-threshold 0.1");
  INFO(result.err);
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Contains("a noise threshold does not go with a `shutter`"));
  std::string adaptive = kFast;
  adaptive.replace(adaptive.find("\"spp\": 16"), 9, "\"spp\": 16, \"noise_threshold\": 0");
  folder.write("adaptive.json", adaptive);
  CHECK_THAT(folder.run("render adaptive.json -o a.png").err, Contains("add --uniform"));
  REQUIRE(folder.run("render adaptive.json --uniform -o a.exr -q").code == 0);
  REQUIRE(folder.run("render fast.json -o b.exr -q").code == 0);
  CHECK((folder.read("a.exr") == folder.read("b.exr")));
}

TEST_CASE("cli shutter: without a time nothing blurs, and a warning says so", "[cli]") {
  const Moving folder;
  folder.write("frame.json", R"({"version": 1, "params": {"frame": 0}, "film": {"width": 8, "height": 8},
    "camera": {"position": [0, 0, 4], "shutter": 0.5}, "background": [1, 1, 1], "objects": [{"type": "sphere", "radius": "1 + frame"}]})");
  const Result result = folder.run("render frame.json -o a.png");
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("[W0517]") && Contains("the scene has no parameter `time`"));
  CHECK(folder.run("render frame.json --frames 0:2 -o a.png -q").code == 0);
}

TEST_CASE("cli shutter: errors while it is open name the time, and check finds them", "[cli]") {
  const Moving folder;
  folder.write("shrink.json", R"({"version": 1, "params": {"time": 0}, "film": {"width": 4, "height": 4, "fps": 1},
    "camera": {"position": [0, 0, 4], "shutter": 1}, "background": [1, 1, 1],
    "objects": [{"type": "sphere", "radius": "1.5 - time"}]})");
  const Result result = folder.run("render shrink.json --frames 0:3 -o a.png -s 16");
  INFO(result.err);
  CHECK(result.code == 65);
  CHECK_THAT(result.err, Contains("while the shutter is open") && Contains("frame 1 (1 s)"));
  const Result check = folder.run("check shrink.json --frames 0:2");
  INFO(check.err);
  CHECK(check.code == 1);
  CHECK_THAT(check.err, Contains("frame 1 (1 s) has errors") && !Contains("frame 0 (0 s) has errors"));
}

}  // namespace
}  // namespace fathom::cli_shutter_test
