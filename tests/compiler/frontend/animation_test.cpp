// Tests of the animation settings of scenes.
#include "compiler/frontend/animation.h"

#include "compiler/artefact/compiled_file.h"
#include "compiler/compile.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::animation_test {
namespace {

using namespace fathom::compiler;

std::optional<Animation> animation_of(const std::string& text, const Definitions& definitions = {}) {
  Diagnostics diagnostics;
  Source source("scene", text);
  const auto animation = read_animation(source, diagnostics, {}, definitions);
  CHECK(animation.has_value() == !diagnostics.has_errors());
  return animation;
}

std::string json(const std::string& rest) {
  return R"({"version": 1, )" + rest + R"(, "objects": [{"type": "sphere", "radius": 1}]})";
}

TEST_CASE("animation: a scene moves that declares `time` or `frame`, in either notation", "[frontend]") {
  for (const std::string& text :
       {json(R"("params": {"time": 0})"), std::string("fathom 1\nparam time = 0\nobject sphere(1)")}) {
    const auto animation = animation_of(text);
    REQUIRE(animation);
    CHECK((animation->time && !animation->frame && !animation->frames && animation->fps == 24));
  }
  const auto both =
      animation_of("fathom 1\nparam frame = 0\nparam time = 0\nfilm (frames = 2*24, fps = 30)\nobject sphere(1)");
  REQUIRE(both);
  CHECK((both->time && both->frame && both->frames == 48 && both->fps == 30));
  const auto still =
      animation_of(json(R"("params": {"Time": 0, "n": 7}, "film": {"frames": "n", "fps": "2*n"})"), {{"n", 9}});
  REQUIRE(still);
  CHECK((!still->time && !still->frame && still->frames == 9 && still->fps == 18));
}

TEST_CASE("animation: what is wrong with its numbers is reported", "[frontend]") {
  for (const char* film : {R"("film": {"frames": 0})", R"("film": {"frames": 1.5})", R"("film": {"fps": 0})",
                           R"("film": {"fps": "1/0"})", R"("film": {"framse": 3})"}) {
    INFO(film);
    CHECK_FALSE(animation_of(json(film)));
  }
  CHECK_FALSE(animation_of("fathom 1\nparam time ="));
  CHECK_FALSE(animation_of(json(R"("params": {"time": 0})"), {{"tmie", 1}}));
}

TEST_CASE("animation: a moment sets what the scene declares", "[frontend]") {
  Animation animation;
  CHECK(moment(animation, 3, 0.5).empty());
  animation.time = true;
  CHECK(moment(animation, 3, 0.5) == Definitions{{"time", 0.5}});
  animation.frame = true;
  CHECK(moment(animation, 3, 0.5) == Definitions{{"time", 0.5}, {"frame", 3}});
}

TEST_CASE("animation: frames, fps and shutter are read, and leave the digest of a scene as it was", "[frontend]") {
  const std::string plain =
      json(R"("camera": {"position": [0, 0, 4]}, "background": [1, 1, 1], "params": {"time": 0})");
  const std::string moving = json(
      R"("camera": {"position": [0, 0, 4], "shutter": 0.25}, "background": [1, 1, 1], "params": {"time": 0}, "film": {"frames": 5, "fps": 12})");
  Diagnostics diagnostics;
  const auto a = compile(Source("a", plain), diagnostics), b = compile(Source("b", moving), diagnostics);
  REQUIRE((a && b));
  CHECK((a->camera.shutter == 0 && !a->film.frames && a->film.fps == 24));
  CHECK((b->camera.shutter == 0.25 && b->film.frames == 5 && b->film.fps == 12));
  CHECK(scene_digest(*a) == scene_digest(*b));
  for (const char* type : {"orthographic", "panorama"}) {
    const auto scene = compile(
        Source("c", json(std::string(R"("camera": {"type": ")") + type + R"(", "shutter": 1})")), diagnostics);
    REQUIRE(scene);
    CHECK(scene->camera.shutter == 1);
  }
  for (const char* wrong : {"-0.1", "1.1"}) {
    Diagnostics errors;
    CHECK_FALSE(compile(Source("d", json(std::string(R"("camera": {"shutter": )") + wrong + "}")), errors));
  }
}

TEST_CASE("animation: an origin that is given is the programs'", "[frontend]") {
  Diagnostics diagnostics;
  CompileOptions options;
  options.origin = glm::dvec3(64, 0, -32);
  const auto scene = compile(Source("a", json(R"("background": [1, 1, 1])")), diagnostics, options);
  REQUIRE(scene);
  CHECK(scene->origin == glm::dvec3(64, 0, -32));
  CHECK(scene->bound.contains(glm::dvec3(-64, 0, 32)));
}

}  // namespace
}  // namespace fathom::animation_test
