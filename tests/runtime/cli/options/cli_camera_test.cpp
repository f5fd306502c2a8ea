// Scenes without a camera, and --position, --look-at and --frame.
#include <algorithm>
#include <cstring>
#include <sstream>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_camera_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

std::string scene_of(const std::string& objects, const std::string& rest = "") {
  return R"({"version": 1, "film": {"width": 40, "height": 24}, "render": {"spp": 4}, "background": [1, 1, 1],
  "materials": {"black": {"type": "diffuse", "color": [0, 0, 0]}}, )" +
         rest + "\"objects\": [" + objects + "]}";
}

std::string ball(const std::string& radius, const std::string& at) {
  return R"({"type": "sphere", "radius": )" + radius + R"(, "translate": [)" + at + R"(], "material": "black"})";
}

// Returns the camera's text from the -v output.
std::string camera_of(const Result& result) {
  const std::size_t begin = result.err.find("\"camera\": {");
  REQUIRE(begin != std::string::npos);
  return result.err.substr(begin, result.err.find('\n', begin) - begin);
}

// Smallest values of a .pfm image (bottom row first): in the middle, at the border, overall.
struct Darkness {
  float middle = 1, border = 1, all = 1;
};
Darkness darkness_of(const Folder& folder, const std::string& name) {
  const std::string text = folder.read(name);
  int width = 0, height = 0;
  std::istringstream head(text);
  std::string magic, order;
  head >> magic >> width >> height >> order;
  REQUIRE(magic == "PF");
  const char* numbers = text.data() + static_cast<std::size_t>(head.tellg()) + 1;
  Darkness least;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float value;
      std::memcpy(&value, numbers + 12 * (y * width + x), 4);
      least.all = std::min(least.all, value);
      if (x == 0 || y == 0 || x == width - 1 || y == height - 1) least.border = std::min(least.border, value);
      if (x == width / 2 && y == height / 2) least.middle = std::min(least.middle, value);
    }
  }
  return least;
}

}  // namespace

TEST_CASE("cli: a scene without a camera is in the picture as a whole, whatever its size, place and the picture's",
          "[cli]") {
  const Folder folder;
  for (const std::string& objects :
       {ball("1", "0, 0, 0"), ball("1e-3", "0.5, 0, 0"), ball("0.5", "1e6, -2e5, 3"), ball("300", "0, 500, 0")}) {
    folder.write("a.json", scene_of(objects));
    for (const char* size : {"", "--size 12x40", "--size 60x8", "--fov 100deg", "-r 17 --aspect 1:1"}) {
      CAPTURE(objects, size);
      const Result result = folder.run(std::string("render a.json -q -o a.pfm ") + size);
      REQUIRE(result.code == 0);
      const Darkness least = darkness_of(folder, "a.pfm");
      CHECK(least.middle == 0);
      CHECK(least.border == 1);
    }
  }
}

TEST_CASE("cli: a ground beside things does not keep them from being framed", "[cli]") {
  const Folder folder;
  folder.write("a.json", scene_of(ball("0.01", "3, 0.01, 0") + R"(, {"type": "plane", "normal": [0, 1, 0]})"));
  REQUIRE(folder.run("render a.json -q -o a.pfm").code == 0);
  CHECK(darkness_of(folder, "a.pfm").middle == 0);
}

TEST_CASE("cli: -v prints the camera as a scene file has it, and that renders to the same picture", "[cli]") {
  const Folder folder;
  const std::string objects = ball("1", "0.3, 0.2, -7");
  folder.write("a.json", scene_of(objects));
  const Result result = folder.run("render a.json -v -o a.pfm --fov 30deg");
  REQUIRE(result.code == 0);
  const std::string camera = camera_of(result);
  CHECK_THAT(camera, Contains("\"fov\": 30}"));
  folder.write("b.json", scene_of(objects, camera + ", "));
  REQUIRE(folder.run("render b.json -q -o b.pfm").code == 0);
  CHECK(folder.read("a.pfm") == folder.read("b.pfm"));
  // The camera of a scene is not reframed.
  CHECK(camera_of(folder.run("render b.json -v -o b.pfm --size 9x40")) == camera);
}

TEST_CASE("cli: a camera that says nothing is not the lack of one", "[cli]") {
  const Folder folder;
  folder.write("a.json", scene_of(ball("1", "0, 0, 0"), "\"camera\": {}, "));
  CHECK(camera_of(folder.run("render a.json -v -o a.png")) ==
        R"("camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 45})");
}

TEST_CASE("cli: --position, --look-at and --frame place the camera of any scene", "[cli]") {
  const Folder folder;
  const auto camera = [&](const std::string& arguments) {
    const Result result = folder.run("render ball.json -v -o a.pfm " + arguments);
    CAPTURE(result.err);
    REQUIRE(result.code == 0);
    return camera_of(result);
  };
  CHECK_THAT(camera("--position 1,2,3"), Contains(R"("position": [1, 2, 3], "target": [0, 0, 0])"));
  CHECK_THAT(camera("--look-at 0,0.25,0"), Contains(R"("position": [0, 0, 4], "target": [0, 0.25, 0])"));
  CHECK_THAT(camera("--position=-1,0,0.5 --look-at=-2,0,1"),
             Contains(R"("position": [-1, 0, 0.5], "target": [-2, 0, 1])"));
  CHECK(camera("--frame").find("\"position\": [0, 0, 4]") == std::string::npos);
  CHECK_THAT(camera("--frame"), Contains("\"position\": [0, 0, "));  // the viewing direction stays
  CHECK(camera("--frame") == camera("--frame --position 0,0,77"));
  CHECK_THAT(camera("--frame --position 9,0,0"), Contains(", 0, 0], \"target\": [0, 0, 0]"));
}

TEST_CASE("cli: options that make no camera are exit code 2, with a remedy", "[cli]") {
  const Folder folder;
  folder.write("ground.json", scene_of(R"({"type": "plane", "normal": [0, 1, 0]})"));
  const auto says = [&](const std::string& arguments, const std::string& text) {
    const Result result = folder.run("render " + arguments);
    CAPTURE(arguments);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains(text));
  };
  says("ball.json --position 1,2", "`1,2` is not a point");
  says("ball.json --look-at here", "write three numbers");
  says("ball.json --look-at 0,0,4", "the camera would look at its own place, [0, 0, 4]");
  says("ball.json --look-at 0,0,4", "move one of them");
  says("ground.json --frame", "nothing in the scene has an end");
  says("ground.json --frame", "--position X,Y,Z --look-at X,Y,Z");
  CHECK(folder.run("render ground.json -q -o a.png").code == 0);
}

// The default `up` is then parallel to the viewing direction and cannot orient the camera.
TEST_CASE("cli: a view from straight above has -z up, one from straight below too", "[cli]") {
  const Folder folder;
  for (const std::string from : {"0,9,0", "0,-9,0"}) {
    const Result result =
        folder.run("render ball.json --look-at 0,0,0 -v -s 1 --size 8x8 -o a.png --position " + from);
    CHECK(result.code == 0);
    CHECK_THAT(result.err, Contains("\"up\": [0, 0, -1]"));
  }
}

TEST_CASE("cli: a checkpoint of another place of the camera is another render's", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -q -o a.film").code == 0);
  REQUIRE(folder.run("render ball.json -q -o b.film --position 0,1,4").code == 0);
  const Result result = folder.run("merge a.film b.film -o c.png");
  CHECK(result.code != 0);
  CHECK_THAT(result.err, Contains("camera"));
}

}  // namespace fathom::cli_camera_test
