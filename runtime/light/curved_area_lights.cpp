#include "runtime/light/curved_area_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/base/angle.h"
#include "runtime/base/elementary.h"
#include "runtime/light/area_light_sampling.h"
#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

using compiler::AreaLight;
using glm::dvec2;
using glm::dvec3;

// --- spheres, about a centre

// Returns 1 - cos of half the angle that a ball subtends, without cancellation. 0 if `from` is within or on the ball.
double ball_height(dvec3 from, dvec3 centre, double radius) {
  const double sin2 = sqr(radius) / glm::dot(centre - from, centre - from);
  return sin2 < 1 ? sin2 / (1 + std::sqrt(1 - sin2)) : 0;
}
}  // namespace

double ball_pdf(dvec3 from, dvec3 centre, double radius) {
  const double height = ball_height(from, centre, radius);
  return height > 0 ? 1 / (2 * kPi * height) : 0;
}

namespace {

// Returns a unit vector perpendicular to the unit vector `axis`.
dvec3 across(dvec3 axis) {
  dvec3 other(0);
  other[std::abs(axis.x) < 0.6 ? 0 : 1] = 1;
  return glm::normalize(glm::cross(axis, other));
}

}  // namespace

ShapeSample sample_ball(dvec3 from, dvec3 centre, double radius, dvec2 u) {
  const double height = ball_height(from, centre, radius);
  if (!(height > 0)) return {};
  const double below = u.x * height;  // 1 - cos
  const double sine = std::sqrt(below * (2 - below)), cosine = 1 - below;
  const double distance = glm::length(centre - from);
  const dvec3 axis = (centre - from) / distance, side = across(axis);
  const SinCos turn = sincos_turn(static_cast<float>(u.y));
  const dvec3 out = static_cast<double>(turn.cos) * side + static_cast<double>(turn.sin) * glm::cross(axis, side);
  const double t = distance * cosine - std::sqrt(std::max(0.0, sqr(radius) - sqr(distance * sine)));
  const dvec3 normal = glm::normalize(from + t * (cosine * axis + sine * out) - centre);
  return {centre + radius * normal, normal, 1 / (2 * kPi * height)};
}

namespace {

// --- about the y axis

// The part of a cylinder's side that `from` sees, up to half_turn_ in either direction from where `from` is.
struct Side {
  Side(dvec3 from, double radius, double half_height)
      : radius_(radius), half_height_(half_height), axis_distance_(std::sqrt(sqr(from.x) + sqr(from.z))) {
    if (axis_distance_ > radius) half_turn_ = vm::real::acos(radius / axis_distance_);
  }
  bool seen() const { return half_turn_ > 0; }
  double area() const { return 4 * half_turn_ * radius_ * half_height_; }

  // Returns about the solid angle: the area of the silhouette as seen by the nearest point at the axis' heights.
  double weight(dvec3 from) const {
    if (!seen()) return 0;
    const double beyond = std::max(0.0, std::abs(from.y) - half_height_), near = axis_distance_ - radius_;
    const double d2 = sqr(beyond) + sqr(near) + sqr(std::min(radius_, half_height_)) / 4;
    const double width = 2 * radius_ * std::sqrt(1 - sqr(radius_ / axis_distance_));
    const double level = axis_distance_ / std::sqrt(sqr(axis_distance_) + sqr(beyond));
    return std::min(2 * kPi, width * 2 * half_height_ * level / d2);
  }

  ShapeSample sample(dvec3 from, dvec2 u) const {
    const double turn = (2 * u.x - 1) * half_turn_;
    const double c = vm::real::cos(turn), s = vm::real::sin(turn);
    const double x = from.x / axis_distance_, z = from.z / axis_distance_;
    ShapeSample out;
    out.normal = {c * x + s * z, 0, c * z - s * x};
    out.position = radius_ * out.normal + dvec3(0, (2 * u.y - 1) * half_height_, 0);
    out.pdf = area_to_solid_angle(out, from, area());
    return out;
  }
  double pdf(dvec3 from, dvec3 hit) const {
    return seen() ? area_to_solid_angle({hit, glm::normalize(dvec3(hit.x, 0, hit.z))}, from, area()) : 0;
  }

 private:
  double radius_, half_height_, axis_distance_, half_turn_ = 0;
};

// Weights of the cap and the side. A cap is seen only from beyond its plane.
DiscreteDistribution<2> cylinder_parts(const AreaLight& area_light, dvec3 from, const Side& side) {
  DiscreteDistribution<2> parts;
  const double above = std::abs(from.y) - area_light.half_height, r2 = sqr(area_light.radius);
  const double d2 = sqr(above) + sqr(from.x) + sqr(from.z) + r2 / 2;
  if (above > 0) parts.weights[0] = kPi * r2 * above / (d2 * std::sqrt(d2));
  parts.weights[1] = side.weight(from);
  return parts;
}

}  // namespace

ShapeSample sample_cylinder(const AreaLight& area_light, dvec3 from, dvec2 u) {
  const Side side(from, area_light.radius, area_light.half_height);
  const DiscreteDistribution<2> parts = cylinder_parts(area_light, from, side);
  if (!(parts.sum() > 0)) return {};
  const std::size_t part = parts.sample(u.x);
  ShapeSample out;
  if (part == 0) {
    const double r = area_light.radius * std::sqrt(u.x);
    const SinCos turn = sincos_turn(static_cast<float>(u.y));
    out.normal = dvec3(0, from.y > 0 ? 1 : -1, 0);
    out.position = {r * static_cast<double>(turn.cos), out.normal.y * area_light.half_height,
                    r * static_cast<double>(turn.sin)};
    out.pdf = area_to_solid_angle(out, from, kPi * sqr(area_light.radius));
  } else {
    out = side.sample(from, u);
  }
  out.pdf *= parts.pmf(part);
  return out;
}

double cylinder_pdf(const AreaLight& area_light, dvec3 from, dvec3 hit) {
  const Side side(from, area_light.radius, area_light.half_height);
  const DiscreteDistribution<2> parts = cylinder_parts(area_light, from, side);
  if (!(parts.sum() > 0)) return 0;
  const bool on_side =
      std::abs(hit.y) - area_light.half_height < std::sqrt(sqr(hit.x) + sqr(hit.z)) - area_light.radius;
  if (on_side) return parts.pmf(1) * side.pdf(from, hit);
  const dvec3 up(0, hit.y > 0 ? 1 : -1, 0);
  return parts.pmf(0) * area_to_solid_angle({hit, up}, from, kPi * sqr(area_light.radius));
}

double cylinder_distance(const AreaLight& area_light, dvec3 p) {
  const double out = std::sqrt(sqr(p.x) + sqr(p.z)) - area_light.radius, up = std::abs(p.y) - area_light.half_height;
  return std::abs(std::min(std::max(out, up), 0.0) + std::sqrt(sqr(std::max(out, 0.0)) + sqr(std::max(up, 0.0))));
}

namespace {

dvec3 ball_of(const AreaLight& area_light, bool upper) {
  return {0, upper ? area_light.half_height : -area_light.half_height, 0};
}

}  // namespace

double capsule_distance(const AreaLight& area_light, dvec3 p) {
  return glm::length(p - dvec3(0, std::clamp(p.y, -area_light.half_height, area_light.half_height), 0)) -
         area_light.radius;
}

namespace {

// Weights of the lower ball, the upper ball and the side. A ball that is not the nearer end counts half, because only
// half of the ball is outside the solid.
DiscreteDistribution<3> capsule_parts(const AreaLight& area_light, dvec3 from, const Side& side) {
  DiscreteDistribution<3> parts;
  if (!(capsule_distance(area_light, from) > 0)) return parts;
  for (const bool upper : {false, true}) {
    const bool whole = upper ? from.y > area_light.half_height : from.y < -area_light.half_height;
    parts.weights[upper] = (whole ? 2 : 1) * kPi * ball_height(from, ball_of(area_light, upper), area_light.radius);
  }
  parts.weights[2] = side.weight(from);
  return parts;
}

}  // namespace

ShapeSample sample_capsule(const AreaLight& area_light, dvec3 from, dvec2 u) {
  const Side side(from, area_light.radius, area_light.half_height);
  const DiscreteDistribution<3> parts = capsule_parts(area_light, from, side);
  if (!(parts.sum() > 0)) return {};
  const std::size_t part = parts.sample(u.x);
  ShapeSample out =
      part == 2 ? side.sample(from, u) : sample_ball(from, ball_of(area_light, part == 1), area_light.radius, u);
  out.pdf *= parts.pmf(part);
  if (part < 2 && (part == 1 ? out.position.y : -out.position.y) <= area_light.half_height) out.pdf = 0;
  return out;
}

double capsule_pdf(const AreaLight& area_light, dvec3 from, dvec3 hit) {
  const Side side(from, area_light.radius, area_light.half_height);
  const DiscreteDistribution<3> parts = capsule_parts(area_light, from, side);
  if (!(parts.sum() > 0)) return 0;
  if (std::abs(hit.y) <= area_light.half_height) return parts.pmf(2) * side.pdf(from, hit);
  const bool upper = hit.y > 0;
  if (!(glm::dot(hit - ball_of(area_light, upper), from - hit) > 0)) return 0;
  return parts.pmf(upper) * ball_pdf(from, ball_of(area_light, upper), area_light.radius);
}

}  // namespace fathom::runtime
