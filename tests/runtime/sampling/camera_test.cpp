#include "runtime/sampling/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "runtime/sampling/camera_lanes.h"
#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"
#include "vm/number/real.h"

namespace fathom::runtime::camera_test {
namespace {

compiler::Camera facing_minus_z() {
  compiler::Camera camera;
  camera.position = {0, 0, 5};
  camera.fov = M_PI / 2;
  return camera;
}

TEST_CASE("camera: up is up and right is right", "[sampling]") {
  const Camera camera(facing_minus_z(), 100, 50);
  CHECK(camera.ray(50, 0).direction.y > 0.1);
  CHECK(camera.ray(50, 50).direction.y < -0.1);
  CHECK(camera.ray(100, 25).direction.x > 0.1);
  CHECK(camera.ray(0, 25).direction.x < -0.1);
  CHECK(camera.ray(50, 25).direction.z == Approx(-1));
}

TEST_CASE("camera: fov is the horizontal angle, fov_y the vertical one", "[sampling]") {
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

TEST_CASE("camera: orthographic rays are parallel and as far apart as the width says", "[sampling]") {
  compiler::Camera flat = facing_minus_z();
  flat.projection = compiler::Camera::Projection::Orthographic;
  flat.width = 6;
  const Camera camera(flat, 300, 100);
  CHECK(camera.ray(300, 50).origin.x - camera.ray(0, 50).origin.x == Approx(6));
  CHECK(camera.ray(150, 0).origin.y - camera.ray(150, 100).origin.y == Approx(2));
  CHECK(camera.ray(0, 0).direction == camera.ray(300, 100).direction);
}

TEST_CASE("camera: looking along `up` still gives a picture", "[sampling]") {
  compiler::Camera down = facing_minus_z();
  down.position = {0, 5, 0};
  const Camera camera(down, 10, 10);
  const glm::dvec3 direction = camera.ray(2, 3).direction;
  CHECK(glm::length(direction) == Approx(1));
  CHECK(direction.y < -0.5);
}

compiler::Camera with_lens(double radius, double focus) {
  compiler::Camera camera = facing_minus_z();
  camera.position = {1, 2, 3};
  camera.target = {-1, 1, -4};
  camera.lens_radius = radius;
  camera.focus_distance = focus;
  return camera;
}

glm::dvec3 forward_of(const compiler::Camera& camera) { return glm::normalize(camera.target - camera.position); }

TEST_CASE("camera: without a lens rays are those of the pinhole, bit for bit", "[sampling]") {
  const Camera camera(facing_minus_z(), 30, 20);
  CHECK(!camera.has_lens());
  const CameraRay plain = camera.ray(3.7, 11.2), lens = camera.ray(3.7, 11.2, {0.1f, 0.9f});
  CHECK((plain.origin == lens.origin && plain.direction == lens.direction));
  // The direction by the formula without a lens.
  const double sx = (2 * 3.7 / 30 - 1) * vm::real::tan(M_PI / 4);
  const double sy = (1 - 2 * 11.2 / 20) * (vm::real::tan(M_PI / 4) * (20.0 / 30));
  CHECK(plain.direction ==
        glm::normalize(glm::dvec3(1, 0, 0) * sx + glm::dvec3(0, 1, 0) * sy + glm::dvec3(0, 0, -1)));
}

TEST_CASE("camera: directions in lanes are those of each ray, bit for bit", "[sampling]") {
  compiler::Camera settings = facing_minus_z();
  settings.position = {1.25, -3.5, 7.1};
  settings.target = {0.3, 0.2, -0.1};
  const Camera camera(settings, 317, 211);
  REQUIRE(is_pinhole(camera));
  PinholeRows rows;
  for (std::size_t count = 1; count <= PinholeRows::kCapacity; ++count) {
    for (std::size_t i = 0; i < count; ++i) {
      rows.x[i] = 4.93 * static_cast<double>(i) - 0.37;
      rows.y[i] = 211 - 3.3 * static_cast<double>(i * count % 64);
    }
    set_pinhole_directions(camera, count, rows);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 found(rows.direction[0][i], rows.direction[1][i], rows.direction[2][i]);
      CHECK(found == camera.ray(rows.x[i], rows.y[i]).direction);
    }
  }
}

TEST_CASE("camera: what lies in the focus plane is sharp", "[sampling]") {
  const compiler::Camera spec = with_lens(0.2, 6);
  const Camera camera(spec, 60, 40);
  const glm::dvec3 forward = forward_of(spec);
  const auto at_focus = [&](const CameraRay& ray) {
    const double t = (6 - glm::dot(ray.origin - spec.position, forward)) / glm::dot(ray.direction, forward);
    return ray.origin + t * ray.direction;
  };
  Sampler sampler(0, 0, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const double x = 60 * static_cast<double>(sampler.next()), y = 40 * static_cast<double>(sampler.next());
    const CameraRay ray = camera.ray(x, y, sampler.next2());
    CHECK(glm::length(at_focus(ray) - at_focus(camera.ray(x, y))) < 1e-13);
    CHECK(glm::length(ray.direction) == Approx(1).margin(1e-15));
    CHECK(glm::dot(ray.origin - spec.position, forward) == Approx(0).margin(1e-15));
    CHECK(glm::length(ray.origin - spec.position) <= 0.2 + 1e-12);
  }
}

// Thin lens: a point at distance d has a circle of confusion of width c = 2 R f |d - F| / (d (F - f)) on the sensor.
// The sensor is at distance v behind the lens with 1/f = 1/v + 1/F, and has the width 2 v tan(fov/2).
TEST_CASE("camera: the circle of confusion is that of the thin lens", "[sampling]") {
  const double radius = 0.03, focus = 4, f = 0.05, v = 1 / (1 / f - 1 / focus);
  compiler::Camera spec = with_lens(radius, focus);
  const Camera camera(spec, 1000, 800);
  const glm::dvec3 forward = forward_of(spec);
  for (const double d : {1.5, 3.0, 3.9, 5.0, 40.0}) {
    const double circle = 2 * radius * f * std::abs(d - focus) / (d * (focus - f));
    const double pixels = 1000 * circle / (2 * v * vm::real::tan(spec.fov / 2));
    // The furthest pixels to either side that see the point through some place of the lens. Their ray passes the
    // point at the lens's rim. A ray further out misses the point.
    const glm::dvec3 point = spec.position + d * forward;
    for (const double side : {-1.0, 1.0}) {
      double least = 1e9, min_beyond = 1e9;
      for (int i = 0; i < 4096; ++i) {
        const glm::vec2 rim(static_cast<float>(i) / 4096, 0.5f);  // along the lens's horizontal diameter
        const auto miss = [&](double scale) {
          const CameraRay ray = camera.ray(500 + side * scale * pixels / 2, 400, rim);
          return glm::length(glm::cross(point - ray.origin, ray.direction));
        };
        least = std::min(least, miss(1));
        min_beyond = std::min(min_beyond, miss(1.1));
      }
      CAPTURE(d, side, pixels);
      const double blur = radius * std::abs(d - focus) / focus;  // width of one pixel's rays at the point's distance
      CHECK(least < 2e-3 * blur);
      CHECK(min_beyond > 0.05 * blur);
    }
  }
}

TEST_CASE("camera: focal length and f-stop say what a lens of that name does", "[sampling]") {
  compiler::Camera spec = facing_minus_z();
  spec.focal_length = 50;
  spec.f_stop = 2;
  const Camera camera(spec, 300, 200);
  const glm::dvec3 right = camera.ray(300, 100).direction;
  CHECK(right.x / -right.z == Approx(36.0 / 2 / 50));  // 39.6 degrees
  CHECK(camera.lens_radius() == Approx(0.0125));       // 50 mm over 2, half of that, in metres
  CHECK(camera.focus_distance() == Approx(5));         // the distance of the target
  // The same lens, given by the field of view.
  compiler::Camera by_angle = facing_minus_z();
  by_angle.fov = 2 * std::atan(36.0 / 2 / 50);
  by_angle.f_stop = 2;
  CHECK(Camera(by_angle, 300, 200).lens_radius() == Approx(0.0125));
  by_angle.vertical_fov = 2 * std::atan(24.0 / 2 / 50);
  CHECK(Camera(by_angle, 300, 200).lens_radius() == Approx(0.0125));
}

double chi_square(const std::vector<int>& counts, double expected) {
  double sum = 0;
  for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

TEST_CASE("camera: a round lens is lit evenly", "[sampling]") {
  const Camera camera(with_lens(2, 5), 10, 10);
  // 16 x 16 cells: rings and sectors of equal area.
  std::vector<int> counts(256);
  Sampler sampler(3, 0, 0, 0);
  const int n = 1 << 17;
  for (int i = 0; i < n; ++i) {
    const glm::dvec2 p = camera.lens_point(sampler.next2()) / 2.0;
    const double ring = glm::dot(p, p) * 16, sector = (std::atan2(p.y, p.x) / (2 * M_PI) + 0.5) * 16;
    REQUIRE(ring <= 16 * (1 + 1e-12));
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(ring), 15) * 16 +
             std::min<std::size_t>(static_cast<std::size_t>(sector), 15)];
  }
  CHECK(chi_square(counts, n / 256.0) < 255 + 4 * std::sqrt(510.0));
}

TEST_CASE("camera: blades make a regular polygon, lit evenly", "[sampling]") {
  for (const int blades : {3, 5, 6, 9}) {
    compiler::Camera spec = with_lens(1, 5);
    spec.blades = blades;
    const Camera camera(spec, 10, 10);
    const double area = blades * std::sin(2 * M_PI / blades) / 2;
    const double apothem = std::cos(M_PI / blades);
    Sampler sampler(4, 0, 0, 0);
    const int n = 1 << 16;
    std::vector<int> counts(64);
    int inner = 0;
    for (int i = 0; i < n; ++i) {
      const glm::dvec2 p = camera.lens_point(sampler.next2());
      // The point must be inside the polygon. Cells of equal area are sectors, counted from the upper corner, and
      // shells.
      const double turn = std::atan2(-p.x, p.y) / (2 * M_PI), sector = (turn < 0 ? turn + 1 : turn) * blades;
      const double within = (sector - std::floor(sector) - 0.5) * 2 * M_PI / blades;
      const double shell = glm::length(p) * std::cos(within) / apothem;
      REQUIRE(shell <= 1 + 1e-6);
      if (glm::length(p) < apothem / 2) ++inner;
      ++counts[std::min<std::size_t>(static_cast<std::size_t>(shell * shell * 8), 7) * 8 +
               static_cast<std::size_t>(static_cast<int>(sector) % blades * 8 / blades)];
    }
    CAPTURE(blades);
    // A disc inside the polygon gets its share of the polygon's area.
    const double share = M_PI * apothem * apothem / 4 / area;
    CHECK(inner / static_cast<double>(n) == Approx(share).margin(4 * std::sqrt(share / n)));
    std::vector<int> shells(8);
    for (std::size_t i = 0; i < 64; ++i) shells[i / 8] += counts[i];
    CHECK(chi_square(shells, n / 8.0) < 7 + 4 * std::sqrt(14.0));
    // A corner is at the top. A rotation by 90 degrees moves it to the left.
    CHECK(camera.lens_point({0, 0.999999f}).y == Approx(1).margin(1e-5));
    spec.blade_rotation = M_PI / 2;
    CHECK(Camera(spec, 10, 10).lens_point({0, 0.999999f}).x == Approx(-1).margin(1e-5));
  }
}

TEST_CASE("camera: a panorama shows all directions, level, the target in its middle", "[sampling]") {
  compiler::Camera spec = facing_minus_z();
  spec.projection = compiler::Camera::Projection::Panorama;
  spec.target = {0, -3, 0};  // below the camera: the horizon stays level
  spec.up = {0, 2, 0};
  const Camera camera(spec, 400, 200);
  const auto close = [](glm::dvec3 a, glm::dvec3 b) { return glm::length(a - b) < 1e-14; };
  CHECK(close(camera.ray(200, 100).direction, {0, 0, -1}));
  CHECK(close(camera.ray(300, 100).direction, {1, 0, 0}));
  CHECK(close(camera.ray(100, 100).direction, {-1, 0, 0}));
  CHECK(close(camera.ray(0, 100).direction, {0, 0, 1}));
  CHECK(close(camera.ray(400, 100).direction, {0, 0, 1}));
  CHECK(close(camera.ray(123, 0).direction, {0, 1, 0}));
  CHECK(close(camera.ray(321, 200).direction, {0, -1, 0}));
  CHECK(close(camera.ray(200, 50).direction, {0, std::sqrt(0.5), -std::sqrt(0.5)}));
  CHECK(close(camera.ray(7, 9).origin, spec.position));
  CHECK(close(camera.ray(-1, 60).direction, camera.ray(399, 60).direction));
}

}  // namespace
}  // namespace fathom::runtime::camera_test
