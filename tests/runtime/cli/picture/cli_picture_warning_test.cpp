// Warnings of `check` and `render` about images that show nothing: no light, nothing in view, black or a single
// color.
#include <string>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_picture_warning_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;

// A ball at the origin with the given camera, and `more` properties of the scene.
std::string ball(const std::string& camera, const std::string& more) {
  return R"({"version": 1, "camera": {)" + camera +
         R"(}, "film": {"width": 32, "height": 18}, "render": {"spp": 1}, )" + more +
         R"("objects": [{"type": "sphere", "radius": 1}]})";
}

constexpr const char* kInFront = R"("position": [0, 0, 4], "target": [0, 0, 0])";
constexpr const char* kWhite = R"("background": [1, 1, 1], )";

// Returns the messages of `render -q` on standard error.
std::string said(const Folder& folder, const std::string& scene, const std::string& options = "") {
  folder.write("scene.json", scene);
  const auto result = folder.run("render scene.json -o a.png -q " + options);
  CHECK(result.code == 0);
  return result.err;
}

}  // namespace

TEST_CASE("cli: check and render warn of a scene without light", "[cli]") {
  const Folder folder;
  CHECK_THAT(said(folder, ball(kInFront, "")), Contains("[W0515]: there is no light") && Contains("`background`"));
  CHECK_THAT(folder.run("check scene.json").err, Contains("[W0515]: there is no light"));
  const std::string bulb = R"("lights": {"bulb": {"type": "point", "position": )";
  CHECK_THAT(said(folder, ball(kInFront, bulb + "[0, 0.5, 0]}}, ")),
             Contains("[W0515]: no light reaches the camera") && Contains("inside a solid"));
  CHECK(said(folder, ball(kInFront, bulb + "[0, 2, 3]}}, ")) == "");
  // Emissive materials count only when an object uses them.
  const std::string glow = R"("materials": {"glow": {"type": "emissive", "emission": [2, 1, 1]}}, )";
  CHECK_THAT(said(folder, ball(kInFront, glow)), Contains("W0515"));
  CHECK(said(folder,
             R"({"version": 1, )" + glow + R"("objects": [{"type": "sphere", "radius": 1, "material": "glow"}]})",
             "-r 32 -s 1") == "");
}

TEST_CASE("cli: check and render say where a scene is that is out of view", "[cli]") {
  const Folder folder;
  const auto expect = [&](const std::string& target, const std::string& place) {
    const std::string scene = ball(R"("position": [0, 0, 4], "target": )" + target, kWhite);
    CHECK_THAT(said(folder, scene), Contains("nothing is in view: every camera ray missed, for the whole scene is " +
                                             place + "; turn the camera"));
    const auto check = folder.run("check scene.json");
    CHECK(check.code == 0);
    CHECK_THAT(check.err, Contains("[W0516]: nothing is in view: the whole scene is " + place) &&
                              Contains("scene.json: 1 warning"));
  };
  expect("[0, 0, 8]", "behind the camera");
  expect("[9, 0, 0]", "to the left of the view");
  expect("[-9, 0, 0]", "to the right of the view");
  expect("[0, -9, 0]", "above the view");
  expect("[0, 9, 0]", "below the view");
  folder.write("scene.json", ball(kInFront, kWhite));
  CHECK_THAT(folder.run("check scene.json").err, !Contains("W0516"));
  CHECK_THAT(folder.run("check --error-format json scene.json").err, !Contains("W0516"));
}

TEST_CASE("cli: render says of a missed scene whose place no box tells that nothing is in view", "[cli]") {
  const Folder folder;
  const std::string up = R"({"version": 1, "camera": {"position": [0, 1, 0], "target": [0, 9, 0.1]},
    "background": [1, 1, 1], "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": 0}]})";
  CHECK_THAT(said(folder, up, "-r 16 -s 1"),
             Contains("nothing is in view: every camera ray missed; turn the camera"));
  CHECK_THAT(folder.run("check scene.json").err, !Contains("W0516"));
}

TEST_CASE("cli: render warns of a picture that is of one color throughout, and says why", "[cli]") {
  const Folder folder;
  const std::string close = R"("position": [0, 0, 1.01], "target": [0, 0, 0])";
  const auto sky = [](const std::string& color) { return R"("background": [)" + color + "], "; };
  CHECK_THAT(said(folder, ball(close, sky("1e-5, 1e-5, 1e-5"))),
             Contains("the picture is black throughout: its brightest light is") && Contains("try --exposure 1"));
  CHECK_THAT(said(folder, ball(close, sky("1e4, 1e4, 1e4"))),
             Contains("the picture is white throughout: its brightest light is") && Contains("try --exposure -1"));
  CHECK_THAT(said(folder, ball(close, sky("0.5, 0.5, 0.5")), "-s 4"),
             Contains("the picture is one color throughout, #"));
  // A camera inside a solid.
  const std::string within = R"("position": [0, 0, 0.5], "target": [0, 0, 0])";
  CHECK_THAT(said(folder, ball(within, sky("0.5, 0.5, 0.5"))),
             Contains("the picture is black throughout: the camera is inside `") && Contains("--position"));
  const std::string ground = R"({"version": 1, "lights": {"lamp": {"type": "point", "position": [0, 9, 0]}},
    "objects": [{"name": "ground", "type": "plane", "normal": [0, 1, 0], "offset": 6}]})";
  CHECK_THAT(said(folder, ground, "-r 16 -s 1"), !Contains("inside"));  // placed by default
  CHECK_THAT(said(folder, ground, "-r 16 -s 1 --position 0,0,5 --look-at 0,0,0"),
             Contains("the camera is inside `ground`"));
  CHECK_THAT(said(folder, ground, "-r 16 -s 1 --position 0,8,9 --look-at 0,6,0"), !Contains("inside"));
  // Light from behind the ball does not reach the visible side.
  const std::string sun = R"("lights": {"sun": {"type": "directional", "direction": [0, 0, 1]}}, )";
  CHECK_THAT(said(folder, ball(close, sun)), Contains("black throughout: no light reached the camera"));
  // Images that show something get no warning, and neither do crops.
  CHECK(said(folder, ball(kInFront, sky("0.5, 0.5, 0.5"))) == "");
  CHECK(said(folder, ball(kInFront, kWhite), "--crop 0,0,2,2") == "");
  CHECK(said(folder, ball(close, sun), "--crop 0,0,2,2") == "");
}

}  // namespace fathom::cli_picture_warning_test
