#include "tests/support/area_light_patches.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <vector>

#include "runtime/sampling/sampler.h"

namespace fathom::test {

using compiler::AreaLight;
using glm::dvec3;
using runtime::AreaLightShape, runtime::Sampler, runtime::ShapeSample;

namespace {

AreaLight make_area_light(AreaLight::Shape shape) {
  AreaLight area_light;
  area_light.shape = shape;
  const dvec3 z = glm::normalize(dvec3(1, -2, 3)), x = glm::normalize(glm::cross(dvec3(0, 1, 0), z));
  area_light.rotation = glm::dmat3(x, glm::cross(z, x), z);
  area_light.translation = {0.3, -0.2, 0.1};
  return area_light;
}
// Part of an area light's surface, parametrised over the unit square, in the light's local space.
struct Patch {
  std::function<dvec3(double u, double v)> place;
  std::function<glm::dvec2(dvec3)> parameters;  // inverse of `place`, for a point of the patch
  std::function<bool(dvec3)> holds;             // true if a point of the surface lies on the patch
};

// Patch of a surface of revolution about the y axis. `profile` maps u to (distance from the axis, height), and
// `parameter` maps a point back to u.
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

// Part of a sphere of radius r above `sign` times the height h; the whole sphere when sign is 0.
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
// Side of a cylinder or capsule, between the two silhouette lines seen from the local point `from`.
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
Patch face_of_quad(const AreaLight& area_light, double sign) {
  const double skew = area_light.corners[2].x - 1, z = sign * area_light.radius;
  return {[=](double u, double v) { return dvec3(-1 + u * (2 + skew * v), v - 0.5, z); },
          [=](dvec3 q) { return glm::dvec2((q.x + 1) / (2 + skew * (q.y + 0.5)), q.y + 0.5); },
          [=](dvec3 q) { return q.z * sign > 0; }};
}

std::vector<Patch> patches_of(const AreaLight& area_light, dvec3 place) {
  const dvec3 from = glm::transpose(area_light.rotation) * (place - area_light.translation);
  const double r = area_light.radius, h = area_light.half_height;
  std::vector<Patch> patches;
  switch (area_light.shape) {
    case AreaLight::Shape::Sphere:
      return {cap_of_ball(r, 0, 0)};
    case AreaLight::Shape::Cylinder:
      return {side_of(r, h, false, from), disc_of(r, h), disc_of(r, -h)};
    case AreaLight::Shape::Capsule:
      return {side_of(r, h, true, from), cap_of_ball(r, h, 1), cap_of_ball(r, h, -1)};
    case AreaLight::Shape::Quad:
      return {face_of_quad(area_light, 1), face_of_quad(area_light, -1)};
    case AreaLight::Shape::Box:
      for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) patches.push_back(face_of_box(area_light.half_size, axis, sign));
      }
  }
  return patches;
}

constexpr int kBins = 8;  // per side of a patch

std::size_t bin(double t) { return static_cast<std::size_t>(std::clamp(static_cast<int>(t * kBins), 0, kBins - 1)); }

// Integrates the density over each bin of a patch: density per solid angle, times the solid angle of small pieces of
// the surface.
void integrate(const AreaLightShape& shape, const Patch& patch, dvec3 from, int grid, std::vector<double>& expected) {
  const AreaLight& area_light = shape.area_light();
  const std::size_t first = expected.size();
  expected.resize(first + kBins * kBins);
  const double du = 1.0 / (kBins * grid), dv = 1.0 / (kBins * grid), e = 1e-6;
  for (int i = 0; i < kBins * grid; ++i) {
    for (int j = 0; j < kBins * grid; ++j) {
      const double u = (i + 0.5) * du, v = (j + 0.5) * dv;
      const dvec3 along_u = (patch.place(u + e, v) - patch.place(u - e, v)) / (2 * e);
      const dvec3 along_v = (patch.place(u, v + e) - patch.place(u, v - e)) / (2 * e);
      const dvec3 area = area_light.rotation * glm::cross(along_u, along_v) * (du * dv);
      const dvec3 place = area_light.rotation * patch.place(u, v) + area_light.translation, way = place - from;
      const double d2 = glm::dot(way, way), solid_angle = std::abs(glm::dot(area, way)) / (d2 * std::sqrt(d2));
      // Pieces that face away are hidden by the light itself.
      const dvec3 inwards = shape.centre() - place;
      const bool seen = glm::dot(area, way) * glm::dot(area, inwards) > 0;
      if (seen) expected[first + bin(u) * kBins + bin(v)] += shape.pdf(from, place) * solid_angle;
    }
  }
}

// Counts n samples per bin. The last bin counts failed samples.
std::vector<double> count_samples(const AreaLightShape& shape, const std::vector<Patch>& patches, dvec3 from, int n) {
  const AreaLight& area_light = shape.area_light();
  std::vector<double> counts(patches.size() * kBins * kBins + 1);
  for (int i = 0; i < n; ++i) {
    Sampler sampler(1, static_cast<std::uint32_t>(i), 0, 0);
    const ShapeSample s = shape.sample(from, sampler.next2());
    if (!(s.pdf > 0)) {
      ++counts.back();
      continue;
    }
    const dvec3 local = glm::transpose(area_light.rotation) * (s.position - area_light.translation);
    std::size_t patch = 0;
    while (patch + 1 < patches.size() && !patches[patch].holds(local)) ++patch;
    const glm::dvec2 uv = patches[patch].parameters(local);
    ++counts[(patch * kBins + bin(uv.x)) * kBins + bin(uv.y)];
  }
  return counts;
}

}  // namespace

AreaLight ball(double radius) {
  AreaLight area_light = make_area_light(AreaLight::Shape::Sphere);
  area_light.radius = radius;
  return area_light;
}
AreaLight box(dvec3 half) {
  AreaLight area_light = make_area_light(AreaLight::Shape::Box);
  area_light.half_size = half;
  return area_light;
}
AreaLight round(AreaLight::Shape shape, double radius, double half_height) {
  AreaLight area_light = make_area_light(shape);
  area_light.radius = radius;
  area_light.half_height = half_height;
  return area_light;
}
AreaLight quad(double thickness, double skew) {
  AreaLight area_light = make_area_light(AreaLight::Shape::Quad);
  area_light.radius = thickness;
  area_light.corners = {{{-1, -0.5}, {1, -0.5}, {1 + skew, 0.5}, {-1, 0.5}}};
  return area_light;
}

ChiSquare area_light_chi_square(const AreaLightShape& shape, dvec3 from, int samples, int grid) {
  const std::vector<Patch> patches = patches_of(shape.area_light(), from);
  std::vector<double> expected;
  for (const Patch& patch : patches) integrate(shape, patch, from, grid, expected);
  const double mass = std::accumulate(expected.begin(), expected.end(), 0.0);
  expected.push_back(std::max(0.0, 1 - mass));
  for (double& share : expected) share *= samples;
  ChiSquare result = pearson(count_samples(shape, patches, from, samples), expected);
  result.integral = mass;
  return result;
}

}  // namespace fathom::test
