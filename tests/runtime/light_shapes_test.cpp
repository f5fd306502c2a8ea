// Points on lamps: density against where they fall, closed forms of irradiance (P3 to P5), and hits against samples.
#include "runtime/light_shapes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "runtime/sampler.h"
#include "tests/support/effort.h"
#include "tests/support/sample_bins.h"

namespace fathom::runtime {
namespace {

using compiler::Lamp;
using glm::dvec3;

Lamp lamp_of(Lamp::Shape shape) {
  Lamp lamp;
  lamp.shape = shape;
  // Turned and moved, so that no axis is special.
  const dvec3 z = glm::normalize(dvec3(1, -2, 3)), x = glm::normalize(glm::cross(dvec3(0, 1, 0), z));
  lamp.rotation = glm::dmat3(x, glm::cross(z, x), z);
  lamp.translation = {0.3, -0.2, 0.1};
  return lamp;
}
Lamp ball(double radius) {
  Lamp lamp = lamp_of(Lamp::Shape::Sphere);
  lamp.radius = radius;
  return lamp;
}
Lamp box(dvec3 half) {
  Lamp lamp = lamp_of(Lamp::Shape::Box);
  lamp.half_size = half;
  return lamp;
}
Lamp round(Lamp::Shape shape, double radius, double half_height) {
  Lamp lamp = lamp_of(shape);
  lamp.radius = radius;
  lamp.half_height = half_height;
  return lamp;
}
Lamp quad(double thickness, double skew) {
  Lamp lamp = lamp_of(Lamp::Shape::Quad);
  lamp.radius = thickness;
  lamp.corners = {{{-1, -0.5}, {1, -0.5}, {1 + skew, 0.5}, {-1, 0.5}}};
  return lamp;
}

// Where a ray first comes within 1e-10 of the lamp. Lamps are convex, and so is the distance along a ray: the line
// through two of its values falls to 0 before it does.
std::optional<dvec3> meet(const LampShape& shape, dvec3 from, dvec3 w) {
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

struct Case {
  const char* name;
  Lamp lamp;
};
const Case kCases[] = {
    {"sphere", ball(0.7)},
    {"tiny sphere", ball(1e-3)},
    {"box", box({0.5, 0.8, 0.3})},
    {"flat box", box({1, 0.01, 0.6})},
    {"small box", box({0.01, 0.02, 0.01})},
    {"cylinder", round(Lamp::Shape::Cylinder, 0.5, 0.8)},
    {"disc", round(Lamp::Shape::Cylinder, 0.8, 0.005)},
    {"tube", round(Lamp::Shape::Cylinder, 0.05, 1)},
    {"capsule", round(Lamp::Shape::Capsule, 0.4, 0.6)},
    {"rectangle", quad(0.01, 0)},
    {"quadrilateral", quad(0.01, 0.7)},
};
const dvec3 kPlaces[] = {{2, 1, 0.5}, {-0.4, 3, 1}, {0.5, -1.5, -0.9}, {10, -7, 4}};

// A part of a lamp's surface over the unit square, in the lamp's space.
struct Patch {
  std::function<dvec3(double u, double v)> place;
  std::function<glm::dvec2(dvec3)> parameters;  // of a point of the patch
  std::function<bool(dvec3)> holds;             // a point of the surface
};

// About the y axis: by the distance from it and the height.
Patch turned(const std::function<glm::dvec2(double)>& profile, const std::function<double(dvec3)>& parameter,
             const std::function<bool(dvec3)>& holds) {
  const auto place = [profile](double u, double v) {
    const glm::dvec2 p = profile(u);
    return dvec3(p.x * std::cos(2 * M_PI * v), p.y, p.x * std::sin(2 * M_PI * v));
  };
  const auto parameters = [parameter](dvec3 q) {
    const double turn = std::atan2(q.z, q.x) / (2 * M_PI);
    return glm::dvec2(parameter(q), turn < 0 ? turn + 1 : turn);
  };
  return {place, parameters, holds};
}

double across_axis(dvec3 q) { return std::sqrt(q.x * q.x + q.z * q.z); }

// A ball's part above `sign` times the height h; the whole ball when sign is 0.
Patch cap_of_ball(double r, double h, double sign) {
  const auto height = [=](double u) { return sign == 0 ? r * (2 * u - 1) : r * u; };
  return turned(
      [=](double u) {
        return glm::dvec2(std::sqrt(std::max(0.0, r * r - height(u) * height(u))),
                          (sign < 0 ? -1 : 1) * (h + height(u)));
      },
      [=](dvec3 q) { return sign == 0 ? (q.y / r + 1) / 2 : (sign * q.y - h) / r; },
      [=](dvec3 q) { return sign == 0 || sign * q.y > h; });
}
// The side, from the one line along which it turns away from the local place `from` to the other.
Patch side_of(double r, double h, bool capsule, dvec3 from) {
  const double middle = std::atan2(from.z, from.x), half = std::acos(std::min(1.0, r / across_axis(from)));
  return {[=](double u, double v) {
            const double turn = middle + half * (2 * v - 1);
            return dvec3(r * std::cos(turn), (2 * u - 1) * h, r * std::sin(turn));
          },
          [=](dvec3 q) {
            const double turn = std::remainder(std::atan2(q.z, q.x) - middle, 2 * M_PI);
            return glm::dvec2((q.y / h + 1) / 2, (turn / half + 1) / 2);
          },
          [=](dvec3 q) { return capsule ? std::abs(q.y) <= h : std::abs(across_axis(q) - r) < 1e-9 * r; }};
}
Patch disc_of(double r, double y) {
  return turned([=](double u) { return glm::dvec2(r * std::sqrt(u), y); },
                [=](dvec3 q) { return across_axis(q) * across_axis(q) / (r * r); },
                [=](dvec3 q) { return std::abs(across_axis(q) - r) >= 1e-9 * r && q.y * y > 0; });
}
Patch face_of_box(dvec3 half, int axis, double sign) {
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  return {[=](double u, double v) {
            dvec3 q;
            q[axis] = sign * half[axis];
            q[j] = (2 * u - 1) * half[j];
            q[k] = (2 * v - 1) * half[k];
            return q;
          },
          [=](dvec3 q) { return glm::dvec2(q[j] / half[j] + 1, q[k] / half[k] + 1) / 2.0; },
          [=](dvec3 q) { return std::abs(q[axis] - sign * half[axis]) < 1e-9 * half[axis]; }};
}
Patch face_of_quad(const Lamp& lamp, double sign) {
  const double skew = lamp.corners[2].x - 1, z = sign * lamp.radius;
  return {[=](double u, double v) { return dvec3(-1 + u * (2 + skew * v), v - 0.5, z); },
          [=](dvec3 q) { return glm::dvec2((q.x + 1) / (2 + skew * (q.y + 0.5)), q.y + 0.5); },
          [=](dvec3 q) { return q.z * sign > 0; }};
}

std::vector<Patch> patches_of(const Lamp& lamp, dvec3 place) {
  const dvec3 from = glm::transpose(lamp.rotation) * (place - lamp.translation);
  const double r = lamp.radius, h = lamp.half_height;
  std::vector<Patch> patches;
  switch (lamp.shape) {
    case Lamp::Shape::Sphere:
      return {cap_of_ball(r, 0, 0)};
    case Lamp::Shape::Cylinder:
      return {side_of(r, h, false, from), disc_of(r, h), disc_of(r, -h)};
    case Lamp::Shape::Capsule:
      return {side_of(r, h, true, from), cap_of_ball(r, h, 1), cap_of_ball(r, h, -1)};
    case Lamp::Shape::Quad:
      return {face_of_quad(lamp, 1), face_of_quad(lamp, -1)};
    case Lamp::Shape::Box:
      for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) patches.push_back(face_of_box(lamp.half_size, axis, sign));
      }
  }
  return patches;
}

constexpr int kBins = 8, kGrid = 16;  // a side of a patch, of a bin

std::size_t bin(double t) { return static_cast<std::size_t>(std::clamp(static_cast<int>(t * kBins), 0, kBins - 1)); }

// The density's share in each bin of a patch: per solid angle, times the solid angle of pieces of the surface.
void integrate(const LampShape& shape, const Patch& patch, dvec3 from, std::vector<double>& expected) {
  const Lamp& lamp = shape.lamp();
  const std::size_t first = expected.size();
  expected.resize(first + kBins * kBins);
  const double du = 1.0 / (kBins * kGrid), dv = 1.0 / (kBins * kGrid), e = 1e-6;
  for (int i = 0; i < kBins * kGrid; ++i) {
    for (int j = 0; j < kBins * kGrid; ++j) {
      const double u = (i + 0.5) * du, v = (j + 0.5) * dv;
      const dvec3 along_u = (patch.place(u + e, v) - patch.place(u - e, v)) / (2 * e);
      const dvec3 along_v = (patch.place(u, v + e) - patch.place(u, v - e)) / (2 * e);
      const dvec3 area = lamp.rotation * glm::cross(along_u, along_v) * (du * dv);
      const dvec3 place = lamp.rotation * patch.place(u, v) + lamp.translation, way = place - from;
      const double d2 = glm::dot(way, way), solid_angle = std::abs(glm::dot(area, way)) / (d2 * std::sqrt(d2));
      // What turns away is behind the lamp.
      const dvec3 inwards = shape.centre() - place;
      const bool seen = glm::dot(area, way) * glm::dot(area, inwards) > 0;
      if (seen) expected[first + bin(u) * kBins + bin(v)] += shape.pdf(from, place) * solid_angle;
    }
  }
}

// The counts of n samples; the last bin is for no sample.
std::vector<double> count_samples(const LampShape& shape, const std::vector<Patch>& patches, dvec3 from, int n) {
  const Lamp& lamp = shape.lamp();
  std::vector<double> counts(patches.size() * kBins * kBins + 1);
  for (int i = 0; i < n; ++i) {
    Sampler sampler(1, static_cast<std::uint32_t>(i), 0, 0);
    const ShapeSample s = shape.sample(from, sampler.next2());
    if (!(s.pdf > 0)) {
      ++counts.back();
      continue;
    }
    const dvec3 local = glm::transpose(lamp.rotation) * (s.position - lamp.translation);
    std::size_t patch = 0;
    while (patch + 1 < patches.size() && !patches[patch].holds(local)) ++patch;
    const glm::dvec2 uv = patches[patch].parameters(local);
    ++counts[(patch * kBins + bin(uv.x)) * kBins + bin(uv.y)];
  }
  return counts;
}

TEST_CASE("light shapes: points fall as their density says", "[lights]") {
  const int n = test::few(40000);
  for (const Case& c : kCases) {
    const LampShape shape(c.lamp);
    for (const dvec3 from : kPlaces) {
      const std::vector<Patch> patches = patches_of(c.lamp, from);
      std::vector<double> expected;
      for (const Patch& patch : patches) integrate(shape, patch, from, expected);
      const double mass = std::accumulate(expected.begin(), expected.end(), 0.0);
      expected.push_back(std::max(0.0, 1 - mass));
      const std::vector<double> counts = count_samples(shape, patches, from, n);
      const double deviation = test::chi_square_deviation(counts, expected, n);
      CAPTURE(c.name, from.x, mass);
      CHECK(mass < 1.005);
      CHECK(mass > (c.lamp.shape == Lamp::Shape::Capsule ? 0.5 : 0.995));
      CHECK(std::abs(deviation) < 5);
    }
  }
}

TEST_CASE("light shapes: a sample's density is the density of hitting it, and it is seen", "[lights]") {
  for (const Case& c : kCases) {
    const LampShape shape(c.lamp);
    for (const dvec3 from : kPlaces) {
      int good = 0;
      double worst = 0, off = 0, least_facing = 1, unseen = 0;
      for (std::uint32_t i = 0; i < 500; ++i) {
        Sampler sampler(2, i, 0, 0);
        const ShapeSample s = shape.sample(from, sampler.next2());
        if (!(s.pdf > 0)) continue;
        ++good;
        worst = std::max(worst, std::abs(shape.pdf(from, s.position) / s.pdf - 1));
        off = std::max(off, shape.distance(s.position));
        const dvec3 w = glm::normalize(s.position - from);
        least_facing = std::min(least_facing, -glm::dot(w, s.normal));
        const std::optional<dvec3> hit = meet(shape, from, w);
        unseen += !hit || glm::length(*hit - s.position) > 1e-4 * (1 + shape.radius() / -glm::dot(w, s.normal));
      }
      CAPTURE(c.name, from.x);
      CHECK(good > 150);
      CHECK(worst < 1e-6);
      CHECK(off < 1e-6);
      CHECK(least_facing > -1e-6);
      CHECK(unseen <= 2);  // within rounding of an edge
    }
  }
}

TEST_CASE("light shapes: no sample from within, beside a sheet, or behind", "[lights]") {
  for (const Case& c : kCases) {
    const LampShape shape(c.lamp);
    CAPTURE(c.name);
    CHECK(shape.sample(shape.centre(), {0.3f, 0.6f}).pdf == 0);
  }
  const LampShape sheet(quad(0.1, 0));
  CHECK(sheet.sample(sheet.centre() + 3.0 * sheet.lamp().rotation[0], {0.5f, 0.5f}).pdf == 0);
  const dvec3 front = sheet.centre() + 2.0 * sheet.normal();
  CHECK(sheet.pdf(front, sheet.centre() + 0.1 * sheet.normal()) > 0);
  CHECK(sheet.pdf(front, sheet.centre() - 0.1 * sheet.normal()) == 0);
  // Its rounded edge is found by hits alone.
  CHECK(sheet.pdf(front, sheet.centre() + 1.05 * sheet.lamp().rotation[0] + std::sqrt(0.0075) * sheet.normal()) == 0);
}

// Irradiance of radiance 1 by sampling, with its standard error.
struct Mean {
  double value, error;
};
Mean irradiance(const LampShape& shape, dvec3 place, dvec3 normal, int n) {
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

TEST_CASE("light shapes: P3, a ball gives pi L R^2/d^2 cos", "[lights]") {
  const LampShape shape(ball(0.5));
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

TEST_CASE("light shapes: P4, a coaxial disc gives pi L R^2/(R^2 + h^2)", "[lights]") {
  const LampShape shape(round(Lamp::Shape::Cylinder, 0.8, 1e-9));
  const dvec3 axis = shape.lamp().rotation[1];
  for (const double h : {0.5, 2.0}) {
    const Mean e = irradiance(shape, shape.centre() - h * axis, axis, 100000);
    const double truth = M_PI * 0.64 / (0.64 + h * h);
    CAPTURE(h, e.value, truth);
    CHECK(std::abs(e.value - truth) < 4 * e.error);
    CHECK(e.error < 0.005 * truth);
  }
}

TEST_CASE("light shapes: P5, polygons give Lambert's sum over edges", "[lights]") {
  for (const double skew : {0.0, 0.7}) {
    const LampShape shape(quad(1e-9, skew));
    const Lamp& lamp = shape.lamp();
    for (const dvec3 local : {dvec3(0.2, 0.1, 1), dvec3(0.9, -0.6, 0.3), dvec3(0.3, 1.5, -2)}) {
      const dvec3 place = lamp.rotation * local + lamp.translation;
      const dvec3 normal = (local.z > 0 ? -1.0 : 1.0) * shape.normal();
      double truth = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const dvec3 a = glm::normalize(dvec3(lamp.corners[i], 0) - local);
        const dvec3 b = glm::normalize(dvec3(lamp.corners[(i + 1) % 4], 0) - local);
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

}  // namespace
}  // namespace fathom::runtime
