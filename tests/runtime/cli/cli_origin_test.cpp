// End-to-end tests of scenes far from zero: all printed positions are the scene's, whatever origin the programs use.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_origin_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;

// A ball of radius 0.5 over a floor, at x = 1e5.
const char* const kFar = R"({
  "version": 1,
  "background": [1, 1, 1],
  "camera": {"position": [100000, 2, 5], "target": [100000, 0.5, 0]},
  "objects": [
    {"name": "floor", "type": "plane", "normal": [0, 1, 0]},
    {"name": "ball", "type": "sphere", "radius": 0.5, "translate": [100000, 0.5, 0]}
  ]
})";

}  // namespace

TEST_CASE("cli: eval takes the scene's points, far from zero too", "[cli]") {
  const Folder folder;
  folder.write("far.json", kFar);
  CHECK(folder.run("eval far.json --at 100002,0.5,0").out == "0.5 0 1 0 floor\n");
  CHECK(folder.run("eval far.json --at 100000,2,0").out == "1 0 1 0 ball\n");
  CHECK(folder.run("eval far.json --at 100000,2,0 --number f32").out == "1 0 1 0 ball\n");
  CHECK(folder.run("eval far.json --at 100000,2,0 --after graph").out == "1 0 1 0 ball\n");
  const std::string box = folder.run("eval far.json --box 99999.75,1.5,-0.25,100000.25,2,0.25").out;
  double lo = 0, hi = 0;
  REQUIRE(std::sscanf(box.c_str(), "%lf %lf", &lo, &hi) == 2);
  CHECK((lo <= 0.5 && lo > 0.2 && hi >= 1 && hi < 1.3));
}

TEST_CASE("cli: slice draws the scene's coordinates, far from zero too", "[cli]") {
  const Folder folder;
  folder.write("far.json", kFar);
  folder.write("other.json", R"({"version": 1, "objects": [
    {"type": "sphere", "radius": 0.5, "translate": [0, 100000, -200000]}]})");
  const auto inside = [&](const std::string& flags) {
    return folder.run("slice " + flags + " -o a.png --show sign --size 8x8").out;
  };
  // 12 pixels of the ball and two rows of floor.
  CHECK(inside("far.json --box 99999,-0.5,100001,1.5") == "inside 28 of 64 pixels\n");
  CHECK(inside("far.json --box 99999,-1,100001,1 --axis y --at 0.5") == "inside 12 of 64 pixels\n");
  CHECK(inside("far.json --axis x --at 100000 --box -1,0,1,2") == "inside 12 of 64 pixels\n");
  CHECK(inside("far.json --axis x --at 0 --box -1,0,1,2") == "inside 0 of 64 pixels\n");
  CHECK(inside("other.json --axis x --box -200001,99999,-199999,100001") == "inside 12 of 64 pixels\n");
  CHECK(inside("other.json --axis z --at -200000") == inside("other.json --axis y --at 100000"));
}

TEST_CASE("cli: dump says where the programs' origin is, check speaks of the scene", "[cli]") {
  const Folder folder;
  folder.write("far.json", kFar);
  CHECK_THAT(folder.run("dump far.json").out,
             Contains("\n; origin 100000 0 0\n") && Contains("sphere 0.5 at 0 0.5 0"));
  CHECK_THAT(folder.run("dump far.json --stage graph").out, Catch::StartsWith("; origin 100000 0 0\n"));
  CHECK_THAT(folder.run("dump far.json --diff").out, Contains("; pass origin: ") && Contains("+++ origin"));
  CHECK_THAT(folder.run("dump far.json --after origin").out, Contains("transform rows=[1,0,0,0,0,1,0,-0.5"));
  CHECK_THAT(folder.run("dump far.json --after graph").out, !Contains("; origin") && Contains("-100000"));
  const auto json = nlohmann::json::parse(folder.run("dump far.json --format json").out);
  CHECK(json["origin"] == nlohmann::json({100000, 0, 0}));
  CHECK_FALSE(nlohmann::json::parse(folder.run("dump ball.json --format json").out).contains("origin"));
  CHECK_THAT(folder.run("dump ball.json").out, !Contains("; origin"));

  const auto check = folder.run("check far.json --probe 20000");
  CHECK(check.code == 0);
  CHECK(check.err == "");
  CHECK_THAT(check.out, Contains("[99999.5,100000.5]x[0,1]x[-0.5,0.5]") && Contains("no constant broken"));
  // A thin object gets no warning where floats are fine. Thin objects matter only far from the camera or from the
  // programs' origin.
  std::string hair = kFar;
  hair.replace(hair.find("0.5, \"translate\""), 3, "0.005");
  folder.write("hair.json", hair);
  CHECK(folder.run("check hair.json").err == "");
  CHECK_THAT(folder.run("render far.json -o a.png --size 8x8 --spp 1 -vvvv").err,
             Contains("the programs' origin is 100000 0 0") &&
                 Contains(R"("camera": {"position": [100000, 2, 5], "target": [100000, 0.5, 0], )"));
}

}  // namespace fathom::cli_origin_test
