// Samples on area lights: density against the distribution of samples, closed forms of irradiance (P3 to P5), and
// hits against samples.
#include "runtime/light/light_shapes.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <optional>
#include <vector>

#include "runtime/sampling/sampler.h"
#include "tests/support/area_light_patches.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::light_shapes_test {
namespace {

using compiler::AreaLight;
using glm::dvec3;
using test::ball, test::quad, test::round;

// Returns the first point of a ray within 1e-10 of the area light. Area lights are convex, and so is the distance
// along a ray: the secant through two of its values reaches 0 before the distance does.
std::optional<dvec3> meet(const AreaLightShape& shape, dvec3 from, dvec3 w) {
  double t = std::max(0.0, glm::length(shape.centre() - from) - shape.radius() * 1.001);
  const double end = glm::length(shape.centre() - from) + shape.radius() * 1.001;
  double before = INFINITY, step = 0;
  for (int i = 0; i < 200 && t < end; ++i) {
    const double d = shape.distance(from + t * w);
    if (d < 1e-10) return from + t * w;
    if (d >= before) return std::nullopt;
    step = std::max(d, std::isinf(before) ? 0.0 : d * step / (before - d));
    before = d;
    t += step;
  }
  return std::nullopt;
}

TEST_CASE("light shapes: points fall as their density says", "[light]") {
  const int n = test::scaled_cases(40000);
  for (const test::NamedAreaLight& c : test::kAreaLights) {
    const AreaLightShape shape(c.area_light);
    for (const dvec3 from : test::kShadingPoints) {
      const test::ChiSquare result = test::area_light_chi_square(shape, from, n, 16);
      CAPTURE(c.name, from.x, result.describe());
      CHECK(result.integral < 1.005);
      CHECK(result.integral > (c.area_light.shape == AreaLight::Shape::Capsule ? 0.5 : 0.995));
      CHECK(result.p > test::sidak(0.001, 44));
    }
  }
}

TEST_CASE("light shapes: a sample's density is the density of hitting it, and it is seen", "[light]") {
  for (const test::NamedAreaLight& c : test::kAreaLights) {
    const AreaLightShape shape(c.area_light);
    for (const dvec3 from : test::kShadingPoints) {
      int good = 0;
      double worst = 0, off = 0, min_facing = 1, unseen = 0;
      for (std::uint32_t i = 0; i < 500; ++i) {
        Sampler sampler(2, i, 0, 0);
        const ShapeSample s = shape.sample(from, sampler.next2());
        if (!(s.pdf > 0)) continue;
        ++good;
        worst = std::max(worst, std::abs(shape.pdf(from, s.position) / s.pdf - 1));
        off = std::max(off, shape.distance(s.position));
        const dvec3 w = glm::normalize(s.position - from);
        min_facing = std::min(min_facing, -glm::dot(w, s.normal));
        const std::optional<dvec3> hit = meet(shape, from, w);
        unseen += !hit || glm::length(*hit - s.position) > 1e-4 * (1 + shape.radius() / -glm::dot(w, s.normal));
      }
      CAPTURE(c.name, from.x);
      CHECK(good > 150);
      CHECK(worst < 1e-6);
      CHECK(off < 1e-6);
      CHECK(min_facing > -1e-6);
      CHECK(unseen <= 2);  // rounding near an edge
    }
  }
}

TEST_CASE("light shapes: no sample from within, beside a sheet, or behind", "[light]") {
  for (const test::NamedAreaLight& c : test::kAreaLights) {
    const AreaLightShape shape(c.area_light);
    CAPTURE(c.name);
    CHECK(shape.sample(shape.centre(), {0.3f, 0.6f}).pdf == 0);
  }
  const AreaLightShape sheet(quad(0.1, 0));
  CHECK(sheet.sample(sheet.centre() + 3.0 * sheet.area_light().rotation[0], {0.5f, 0.5f}).pdf == 0);
  const dvec3 front = sheet.centre() + 2.0 * sheet.normal();
  CHECK(sheet.pdf(front, sheet.centre() + 0.1 * sheet.normal()) > 0);
  CHECK(sheet.pdf(front, sheet.centre() - 0.1 * sheet.normal()) == 0);
  // Only hits find the sheet's rounded edge.
  CHECK(sheet.pdf(front,
                  sheet.centre() + 1.05 * sheet.area_light().rotation[0] + std::sqrt(0.0075) * sheet.normal()) == 0);
}

// Irradiance by sampling for radiance 1, with its standard error.
struct Mean {
  double value, error;
};
Mean irradiance(const AreaLightShape& shape, dvec3 place, dvec3 normal, int n) {
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    Sampler sampler(3, static_cast<std::uint32_t>(i), 0, 0);
    const ShapeSample s = shape.sample(place, sampler.next2());
    if (!(s.pdf > 0)) continue;
    const double value = std::max(0.0, glm::dot(normal, glm::normalize(s.position - place))) / s.pdf;
    sum += value;
    squares += value * value;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n) + 1e-6 * mean};
}

TEST_CASE("light shapes: P3, a ball gives pi L R^2/d^2 cos", "[light]") {
  const AreaLightShape shape(ball(0.5));
  for (const double d : {1.5, 3.0, 40.0}) {
    const dvec3 w = glm::normalize(dvec3(0.2, 1, -0.4)), place = shape.centre() - d * w;
    const dvec3 normal = glm::normalize(w + 0.4 * glm::cross(w, dvec3(1, 0, 0)));
    const Mean e = irradiance(shape, place, normal, 40000);
    const double truth = M_PI * 0.25 / (d * d) * glm::dot(normal, w);
    CAPTURE(d, e.value, truth);
    CHECK(std::abs(e.value - truth) < 4 * e.error);
    CHECK(e.error < 0.002 * truth);
  }
}

TEST_CASE("light shapes: P4, a coaxial disc gives pi L R^2/(R^2 + h^2)", "[light]") {
  const AreaLightShape shape(round(AreaLight::Shape::Cylinder, 0.8, 1e-9));
  const dvec3 axis = shape.area_light().rotation[1];
  for (const double h : {0.5, 2.0}) {
    const Mean e = irradiance(shape, shape.centre() - h * axis, axis, 100000);
    const double truth = M_PI * 0.64 / (0.64 + h * h);
    CAPTURE(h, e.value, truth);
    CHECK(std::abs(e.value - truth) < 4 * e.error);
    CHECK(e.error < 0.005 * truth);
  }
}

TEST_CASE("light shapes: P5, polygons give Lambert's sum over edges", "[light]") {
  for (const double skew : {0.0, 0.7}) {
    const AreaLightShape shape(quad(1e-9, skew));
    const AreaLight& area_light = shape.area_light();
    for (const dvec3 local : {dvec3(0.2, 0.1, 1), dvec3(0.9, -0.6, 0.3), dvec3(0.3, 1.5, -2)}) {
      const dvec3 place = area_light.rotation * local + area_light.translation;
      const dvec3 normal = (local.z > 0 ? -1.0 : 1.0) * shape.normal();
      double truth = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const dvec3 a = glm::normalize(dvec3(area_light.corners[i], 0) - local);
        const dvec3 b = glm::normalize(dvec3(area_light.corners[(i + 1) % 4], 0) - local);
        truth += 0.5 * std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), dvec3(0, 0, 1));
      }
      truth = std::abs(truth);
      const Mean e = irradiance(shape, place, normal, 40000);
      CAPTURE(skew, local.x, e.value, truth);
      CHECK(std::abs(e.value - truth) < 4 * e.error);
      CHECK(e.error < 0.02 * truth);
    }
  }
}

// Lanes take the numbers of one light from a register, and those of several from memory.
TEST_CASE("light shapes: boxes sampled together are sampled as each alone", "[light]") {
  std::vector<AreaLightShape> shapes;
  std::vector<BoxLight> boxes;
  for (const test::NamedAreaLight& c : test::kAreaLights) {
    const AreaLightShape shape(c.area_light);
    if (!shape.box()) continue;
    shapes.push_back(shape);
    boxes.push_back(*shape.box());
  }
  REQUIRE(boxes.size() > 2);
  for (const std::size_t count : {std::size_t{1}, std::size_t{13}, BoxLightRows::kCapacity}) {
    BoxLightRows rows;
    std::vector<ShapeSample> alone;
    for (std::size_t i = 0; i < count; ++i) {
      Sampler sampler(3, static_cast<std::uint32_t>(i), 0, 0);
      const dvec3 from = test::kShadingPoints[i % std::size(test::kShadingPoints)];
      const glm::vec2 u = sampler.next2();
      rows.set(i, i % boxes.size(), from);
      rows.u[i] = static_cast<double>(u.x);
      rows.v[i] = static_cast<double>(u.y);
      alone.push_back(shapes[i % boxes.size()].sample(from, u));
    }
    sample_box_lights(boxes, count, rows);
    for (std::size_t i = 0; i < count; ++i) {
      const dvec3 from(rows.from[0][i], rows.from[1][i], rows.from[2][i]);
      CAPTURE(count, i);
      CHECK(rows.pdf[i] == alone[i].pdf);
      if (!(alone[i].pdf > 0)) continue;
      CHECK(from + rows.way_of(i) == alone[i].position);
      CHECK(std::abs(rows.distance[i] / glm::length(rows.way_of(i)) - 1) < 1e-12);
      CHECK(std::abs(rows.cosine[i] + glm::dot(alone[i].normal, rows.way_of(i)) / rows.distance[i]) < 1e-12);
    }
  }
}

}  // namespace
}  // namespace fathom::runtime::light_shapes_test
