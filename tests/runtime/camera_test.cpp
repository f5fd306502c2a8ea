#include "runtime/camera.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace fathom::runtime {
namespace {

compiler::Camera facing_minus_z() {
  compiler::Camera camera;
  camera.position = {0, 0, 5};
  camera.fov = M_PI / 2;
  return camera;
}

TEST_CASE("camera: up is up and right is right", "[runtime]") {
  const Camera camera(facing_minus_z(), 100, 50);
  CHECK(camera.ray(50, 0).direction.y > 0.1);
  CHECK(camera.ray(50, 50).direction.y < -0.1);
  CHECK(camera.ray(100, 25).direction.x > 0.1);
  CHECK(camera.ray(0, 25).direction.x < -0.1);
  CHECK(camera.ray(50, 25).direction.z == Approx(-1));
}

TEST_CASE("camera: fov is the horizontal angle, fov_y the vertical one", "[runtime]") {
  const Camera wide(facing_minus_z(), 200, 100);
  const glm::dvec3 right = wide.ray(200, 50).direction, top = wide.ray(100, 0).direction;
  CHECK(right.x / -right.z == Approx(1));
  CHECK(top.y / -top.z == Approx(0.5));

  compiler::Camera by_height = facing_minus_z();
  by_height.vertical_fov = M_PI / 2;
  const Camera tall(by_height, 200, 100);
  CHECK(tall.ray(100, 0).direction.y / -tall.ray(100, 0).direction.z == Approx(1));
  CHECK(tall.ray(200, 50).direction.x / -tall.ray(200, 50).direction.z == Approx(2));
}

TEST_CASE("camera: orthographic rays are parallel and as far apart as the width says", "[runtime]") {
  compiler::Camera flat = facing_minus_z();
  flat.projection = compiler::Camera::Projection::Orthographic;
  flat.width = 6;
  const Camera camera(flat, 300, 100);
  CHECK(camera.ray(300, 50).origin.x - camera.ray(0, 50).origin.x == Approx(6));
  CHECK(camera.ray(150, 0).origin.y - camera.ray(150, 100).origin.y == Approx(2));
  CHECK(camera.ray(0, 0).direction == camera.ray(300, 100).direction);
}

TEST_CASE("camera: looking along `up` still gives a picture", "[runtime]") {
  compiler::Camera down = facing_minus_z();
  down.position = {0, 5, 0};
  const Camera camera(down, 10, 10);
  const glm::dvec3 direction = camera.ray(2, 3).direction;
  CHECK(glm::length(direction) == Approx(1));
  CHECK(direction.y < -0.5);
}

}  // namespace
}  // namespace fathom::runtime
