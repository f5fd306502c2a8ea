// Cameras that show the whole of a box, tested with the rays that the renderer traces.
#include "compiler/scene/framing.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/sampling/camera.h"
#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"

namespace fathom::framing_test {

namespace {

using namespace fathom;
using compiler::Box, compiler::Camera;
using glm::dvec3;

dvec3 corner(const Box& box, int i) {
  return {i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z};
}

// How far the box reaches towards each side of the image: 1 is the image's edge. NaN when a corner is behind the
// camera.
struct Reach {
  double left = 0, right = 0, down = 0, up = 0;
  double across() const { return std::max(left, right); }
  double along() const { return std::max(down, up); }
};

Reach reach_of(const Camera& camera, const Box& box, int width, int height) {
  const runtime::Camera seen(camera, width, height);
  const glm::dvec2 half = seen.half_extent();
  Reach reach{-2, -2, -2, -2};
  for (int i = 0; i < 8; ++i) {
    const dvec3 way = corner(box, i) - seen.position();
    const double depth = glm::dot(way, seen.forward());
    const double unit = camera.projection == Camera::Projection::Orthographic ? 1 : depth;
    if (!(depth > 0)) return {NAN, NAN, NAN, NAN};
    const double x = glm::dot(way, seen.right()) / (unit * half.x), y = glm::dot(way, seen.up()) / (unit * half.y);
    reach = {std::max(reach.left, -x), std::max(reach.right, x), std::max(reach.down, -y), std::max(reach.up, y)};
  }
  return reach;
}

Camera random_view(test::Random& random) {
  Camera camera;
  const double height = random.uniform(-0.95, 0.95), turn = random.uniform(-3, 3),
               level = std::sqrt(1 - height * height);
  camera.position = dvec3(level * std::cos(turn), height, level * std::sin(turn));
  camera.target = dvec3(0);
  return camera;
}

}  // namespace

TEST_CASE("framing: all corners are in the picture and two sides are at the margin", "[scene][framing]") {
  test::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double scale = std::pow(10.0, random.uniform(-6, 6));
    const dvec3 middle = dvec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)) * scale;
    const dvec3 half = dvec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0.01, 1)) * scale;
    const Box box{middle - half, middle + half};
    const int width = static_cast<int>(random.uniform(10, 3000)), height = static_cast<int>(random.uniform(10, 3000));
    Camera camera = random_view(random);
    switch (i % 4) {
      case 0:
        camera.fov = random.uniform(0.05, 2);
        break;
      case 1:
        camera.vertical_fov = random.uniform(0.05, 2);
        break;
      case 2:
        camera.focal_length = random.uniform(10, 300);
        break;
      default:
        camera.projection = Camera::Projection::Orthographic;
    }
    const std::optional<Camera> framed = compiler::framed(camera, box, static_cast<double>(width) / height);
    REQUIRE(framed);
    const Reach reach = reach_of(*framed, box, width, height);
    CAPTURE(i, width, height, reach.left, reach.right, reach.down, reach.up);
    constexpr double kEdge = 1 - 2 * compiler::kFrameMargin;
    CHECK(std::max(reach.across(), reach.along()) <= kEdge + 1e-6);
    // The tighter axis touches the margin on both sides. A wide view is the exception: it stops before the nearest
    // corner comes too close to the eye.
    const dvec3 forward = glm::normalize(framed->target - framed->position);
    double nearest = INFINITY;
    for (int c = 0; c < 8; ++c) nearest = std::min(nearest, glm::dot(corner(box, c) - framed->position, forward));
    const bool close = nearest < 0.0101 * glm::length(box.hi - box.lo);
    CHECK((close || std::max(std::min(reach.left, reach.right), std::min(reach.down, reach.up)) >= kEdge - 0.02));
    const dvec3 before = glm::normalize(camera.target - camera.position),
                after = glm::normalize(framed->target - framed->position);
    CHECK(glm::length(after - before) < 1e-6);
  }
}

TEST_CASE("framing: a panorama is in front of the box", "[scene][framing]") {
  Camera camera;
  camera.projection = Camera::Projection::Panorama;
  const Box box{{1, 1, 1}, {3, 2, 2}};
  const auto framed = compiler::framed(camera, box, 2);
  REQUIRE(framed);
  CHECK(framed->position.z > 2);
  CHECK(!box.contains(framed->position));
  CHECK(framed->position.x == Approx(2));
}

TEST_CASE("framing: no camera shows what is nothing, has no end or is beyond numbers", "[scene][framing]") {
  const Camera camera;
  CHECK(!compiler::framed(camera, Box(), 1));
  CHECK(!compiler::framed(camera, Box::everything(), 1));
  CHECK(!compiler::framed(camera, Box::centred(dvec3(1e200)), 1));
  CHECK(!compiler::framed(camera, Box::centred(dvec3(0)), 1));
  const auto tiny = compiler::framed(camera, Box{{1e6, 0, 0}, {1e6, 0, 0}}, 1);  // a point far from the origin
  REQUIRE(tiny);
  CHECK(glm::length(tiny->target - tiny->position) > 0.1);
}

TEST_CASE("framing: only a camera that the scene does not have is placed", "[scene][framing]") {
  Camera camera;
  camera.focus_distance = 3;
  const Box box = Box::centred(dvec3(1));
  CHECK(compiler::placed(camera, box, 1).position == camera.position);
  CHECK(compiler::placed(camera, box, 1).focus_distance == 3);
  camera.automatic = true;
  const Camera there = compiler::placed(camera, box, 1);
  CHECK(there.position.x > 1);
  CHECK(there.position.y > 1);
  CHECK(there.position.z > 1);
  CHECK(compiler::placed(camera, Box(), 1).position == camera.position);
}

}  // namespace fathom::framing_test
