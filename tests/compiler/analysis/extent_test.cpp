// Tests of a scene's extent: the box of its bounded parts.
#include "compiler/analysis/extent.h"

#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::extent_test {

namespace {

using namespace fathom;
using compiler::Box;
using fathom::test::compiled_objects;
using glm::dvec3;

// Extent in the scene's coordinates.
Box extent_of(const std::string& objects) {
  const compiler::CompiledScene scene = compiled_objects(objects);
  return scene.extent.moved(scene.origin);
}

void check_box(const std::string& objects, dvec3 lo, dvec3 hi) {
  CAPTURE(objects);
  const Box box = extent_of(objects);
  for (int i = 0; i < 3; ++i) {
    CHECK(box.lo[i] == Approx(lo[i]).margin(1e-6));
    CHECK(box.hi[i] == Approx(hi[i]).margin(1e-6));
  }
}

constexpr const char* kBall = R"({"type": "sphere", "radius": 1, "translate": [5, 0, 0]})";
constexpr const char* kGround = R"({"type": "plane", "normal": [0, 1, 0], "offset": -1})";

}  // namespace

TEST_CASE("extent: the union of what ends", "[analysis][extent]") {
  check_box(kBall, {4, -1, -1}, {6, 1, 1});
  check_box(std::string(kBall) + R"(, {"type": "box", "half_size": [1, 2, 3]})", {-1, -2, -3}, {6, 2, 3});
  check_box(R"({"type": "sphere", "radius": 1, "translate": [1e6, 0, 0]})", {1e6 - 1, -1, -1}, {1e6 + 1, 1, 1});
}

TEST_CASE("extent: grounds and endless copies are left out, in groups that are moved, too", "[analysis][extent]") {
  const std::string both = std::string(kGround) + ", " + kBall;
  check_box(both, {4, -1, -1}, {6, 1, 1});
  check_box(R"({"type": "union", "of": [)" + both + R"(], "translate": [0, 7, 0]})", {4, 6, -1}, {6, 8, 1});
  check_box(both + R"(, {"type": "repetition", "period": [9, 9, 9], "of": {"type": "sphere", "radius": 1}})",
            {4, -1, -1}, {6, 1, 1});
}

TEST_CASE("extent: a pit is what there is to see of a ground; what only has no end has no extent",
          "[analysis][extent]") {
  check_box(std::string(R"({"type": "subtraction", "of": [)") + kGround + ", " + kBall + "]}", {4, -1, -1},
            {6, 1, 1});
  CHECK(extent_of(kGround).empty());
  CHECK(extent_of(R"({"type": "gyroid", "period": 1})").empty());
}

// The camera of a scene without an end stood within a copy: the picture was black or grey.
TEST_CASE("extent: an automatic camera stands outside of parts without an end", "[analysis][extent]") {
  for (const char* object : {R"({"type": "repetition", "period": [1, 1, 1], "of": {"type": "sphere", "radius": 0.3}})",
                             R"({"type": "repetition", "period": [1, 0, 1], "of": {"type": "box", "half_size": [0.4, 2, 0.4]}})",
                             R"({"type": "gyroid", "period": 1})", R"({"type": "gyroid", "period": 40})",
                             R"({"type": "plane", "normal": [0, 0, 1], "offset": 30})"}) {
    CAPTURE(object);
    const compiler::CompiledScene scene = compiled_objects(object);
    vm::Workspace workspace;
    CHECK(vm::evaluate_distance(scene.distance, scene.camera.position, workspace) > 0);
  }
}

}  // namespace fathom::extent_test
