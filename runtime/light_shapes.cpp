#include "runtime/light_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "runtime/elementary.h"
#include "runtime/spherical_rectangle.h"
#include "vm/real.h"

namespace fathom::runtime {
namespace {

using compiler::Lamp;
using glm::dvec2;
using glm::dvec3;
constexpr double kPi = std::numbers::pi;

double sqr(double x) { return x * x; }

// The parts of a shape with weights, of which one is chosen by a number that is then as good as new.
template <std::size_t N>
struct Parts {
  std::array<double, N> weights{};

  double sum() const {
    double total = 0;
    for (const double w : weights) total += w;
    return total;
  }
  double share(std::size_t part) const { return weights[part] / sum(); }
  // sum() > 0.
  std::size_t choose(double& u) const {
    double rest = u * sum();
    std::size_t part = 0, last = 0;
    for (std::size_t i = 0; i < N; ++i) {
      if (weights[i] > 0) last = i;
    }
    while (part < last && !(rest < weights[part])) rest -= weights[part++];
    u = std::clamp(rest / weights[part], 0.0, 1.0);
    return part;
  }
};

// Per solid angle, of a point chosen uniformly over an area.
double area_to_solid_angle(const ShapeSample& at, dvec3 from, double area) {
  const dvec3 way = from - at.position;
  const double d2 = glm::dot(way, way), facing = glm::dot(at.normal, way);
  return facing > 0 ? d2 * std::sqrt(d2) / (facing * area) : 0;
}

// --- spheres, about a centre

// 1 - cos of half the angle that a ball subtends, without cancellation; from within or on it none, 0.
double ball_height(dvec3 from, dvec3 centre, double radius) {
  const double sin2 = sqr(radius) / glm::dot(centre - from, centre - from);
  return sin2 < 1 ? sin2 / (1 + std::sqrt(1 - sin2)) : 0;
}
double ball_pdf(dvec3 from, dvec3 centre, double radius) {
  const double height = ball_height(from, centre, radius);
  return height > 0 ? 1 / (2 * kPi * height) : 0;
}

// A unit vector across the unit vector `axis`.
dvec3 across(dvec3 axis) {
  dvec3 other(0);
  other[std::abs(axis.x) < 0.6 ? 0 : 1] = 1;
  return glm::normalize(glm::cross(axis, other));
}

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

// --- boxes

// The faces across each axis, on the side where `from` is; weight 0 where it is within the box's slab.
struct BoxFaces {
  BoxFaces(dvec3 from, dvec3 half) {
    for (int i = 0; i < 3; ++i) {
      if (std::abs(from[i]) > half[i]) parts.weights[static_cast<std::size_t>(i)] = face(from, half, i).solid_angle();
    }
  }
  static SphericalRectangle face(dvec3 from, dvec3 half, int axis) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    return {-half[j] - from[j], half[j] - from[j], -half[k] - from[k], half[k] - from[k],
            std::abs(from[axis]) - half[axis]};
  }
  Parts<3> parts;
};

ShapeSample sample_box(dvec3 from, dvec3 half, dvec2 u) {
  const BoxFaces faces(from, half);
  if (!(faces.parts.sum() > 0)) return {};
  const std::size_t part = faces.parts.choose(u.x);
  const int axis = static_cast<int>(part), j = (axis + 1) % 3, k = (axis + 2) % 3;
  const SphericalRectangle face = BoxFaces::face(from, half, axis);
  const dvec2 place = face.sample(u);
  ShapeSample out;
  out.normal[axis] = from[axis] > 0 ? 1 : -1;
  out.position[axis] = out.normal[axis] * half[axis];
  out.position[j] = from[j] + place.x;
  out.position[k] = from[k] + place.y;
  const dvec3 way = out.position - from;
  out.pdf = faces.parts.share(part) * face.pdf(glm::dot(way, way));
  return out;
}

double box_pdf(dvec3 from, dvec3 half, dvec3 hit) {
  int axis = 0;  // of the face that is nearest
  for (int i = 1; i < 3; ++i) {
    if (std::abs(hit[i]) - half[i] > std::abs(hit[axis]) - half[axis]) axis = i;
  }
  if (!(std::abs(from[axis]) > half[axis]) || (from[axis] > 0) != (hit[axis] > 0)) return 0;
  const dvec3 way = hit - from;
  return BoxFaces(from, half).parts.share(static_cast<std::size_t>(axis)) *
         BoxFaces::face(from, half, axis).pdf(glm::dot(way, way));
}

// --- quads

double cross2(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }

double quad_area(const Lamp& quad) {
  return 0.5 * cross2(quad.corners[2] - quad.corners[0], quad.corners[3] - quad.corners[1]);
}

bool is_rectangle(const Lamp& quad) {
  constexpr double kTolerance = 1e-9;
  const std::array<dvec2, 4>& c = quad.corners;
  const dvec2 a = c[1] - c[0], b = c[3] - c[0];
  const double size2 = glm::dot(a, a) + glm::dot(b, b);
  return std::abs(glm::dot(a, b)) <= kTolerance * size2 &&
         glm::length(c[2] - c[0] - a - b) <= kTolerance * std::sqrt(size2);
}

bool inside_quad(const Lamp& quad, dvec2 p) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (cross2(quad.corners[(i + 1) % 4] - quad.corners[i], p - quad.corners[i]) < 0) return false;
  }
  return true;
}

// The lamp's x axis lies along the first side.
SphericalRectangle face_of(const Lamp& quad, dvec3 from) {
  const dvec2 lo = quad.corners[0], hi = quad.corners[2];
  return {lo.x - from.x, hi.x - from.x, lo.y - from.y, hi.y - from.y, std::abs(from.z) - quad.radius};
}

ShapeSample sample_quad(const Lamp& quad, bool rectangle, dvec3 from, dvec2 u) {
  if (!(std::abs(from.z) > quad.radius)) return {};
  const double side = from.z > 0 ? 1 : -1;
  ShapeSample out{dvec3(0, 0, side * quad.radius), dvec3(0, 0, side)};
  if (rectangle) {
    const SphericalRectangle face = face_of(quad, from);
    const dvec2 place = face.sample(u);
    out.position.x = from.x + place.x;
    out.position.y = from.y + place.y;
    const dvec3 way = out.position - from;
    out.pdf = face.pdf(glm::dot(way, way));
    return out;
  }
  const std::array<dvec2, 4>& c = quad.corners;
  const Parts<2> halves{{cross2(c[1] - c[0], c[2] - c[0]), cross2(c[2] - c[0], c[3] - c[0])}};
  const std::size_t half = halves.choose(u.x);
  // Uniform over a triangle: Turk, "Generating Random Points in Triangles", Graphics Gems, 1990.
  const double root = std::sqrt(u.x);
  const dvec2 place = (1 - root) * c[0] + root * (1 - u.y) * c[1 + half] + root * u.y * c[2 + half];
  out.position.x = place.x;
  out.position.y = place.y;
  out.pdf = area_to_solid_angle(out, from, quad_area(quad));
  return out;
}

double quad_pdf(const Lamp& quad, bool rectangle, dvec3 from, dvec3 hit) {
  if (!(std::abs(from.z) > quad.radius) || (from.z > 0) != (hit.z > 0)) return 0;
  if (!inside_quad(quad, dvec2(hit))) return 0;
  if (!rectangle) return area_to_solid_angle({hit, dvec3(0, 0, from.z > 0 ? 1 : -1)}, from, quad_area(quad));
  const dvec3 way = hit - from;
  return face_of(quad, from).pdf(glm::dot(way, way));
}

double quad_distance(const Lamp& quad, dvec3 p) {
  if (inside_quad(quad, dvec2(p))) return std::abs(std::abs(p.z) - quad.radius);
  double nearest2 = INFINITY;
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec2 a = quad.corners[i], side = quad.corners[(i + 1) % 4] - a, way = dvec2(p) - a;
    const dvec2 off = way - std::clamp(glm::dot(way, side) / glm::dot(side, side), 0.0, 1.0) * side;
    nearest2 = std::min(nearest2, glm::dot(off, off));
  }
  return std::abs(std::sqrt(nearest2 + sqr(p.z)) - quad.radius);
}

// --- about the y axis

// The part of the side of a cylinder that `from` sees: `half_turn` to either side of where it is.
struct Side {
  Side(dvec3 from, double radius, double half_height)
      : radius_(radius), half_height_(half_height), axis_distance_(std::sqrt(sqr(from.x) + sqr(from.z))) {
    if (axis_distance_ > radius) half_turn_ = vm::real::acos(radius / axis_distance_);
  }
  bool seen() const { return half_turn_ > 0; }
  double area() const { return 4 * half_turn_ * radius_ * half_height_; }

  // About its solid angle: the silhouette's area as the nearest point of the axis' height sees it.
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

// Cap and side. A cap is seen from beyond its plane.
Parts<2> cylinder_parts(const Lamp& lamp, dvec3 from, const Side& side) {
  Parts<2> parts;
  const double above = std::abs(from.y) - lamp.half_height, r2 = sqr(lamp.radius);
  const double d2 = sqr(above) + sqr(from.x) + sqr(from.z) + r2 / 2;
  if (above > 0) parts.weights[0] = kPi * r2 * above / (d2 * std::sqrt(d2));
  parts.weights[1] = side.weight(from);
  return parts;
}

ShapeSample sample_cylinder(const Lamp& lamp, dvec3 from, dvec2 u) {
  const Side side(from, lamp.radius, lamp.half_height);
  const Parts<2> parts = cylinder_parts(lamp, from, side);
  if (!(parts.sum() > 0)) return {};
  const std::size_t part = parts.choose(u.x);
  ShapeSample out;
  if (part == 0) {
    const double r = lamp.radius * std::sqrt(u.x);
    const SinCos turn = sincos_turn(static_cast<float>(u.y));
    out.normal = dvec3(0, from.y > 0 ? 1 : -1, 0);
    out.position = {r * static_cast<double>(turn.cos), out.normal.y * lamp.half_height,
                    r * static_cast<double>(turn.sin)};
    out.pdf = area_to_solid_angle(out, from, kPi * sqr(lamp.radius));
  } else {
    out = side.sample(from, u);
  }
  out.pdf *= parts.share(part);
  return out;
}

double cylinder_pdf(const Lamp& lamp, dvec3 from, dvec3 hit) {
  const Side side(from, lamp.radius, lamp.half_height);
  const Parts<2> parts = cylinder_parts(lamp, from, side);
  if (!(parts.sum() > 0)) return 0;
  const bool on_side = std::abs(hit.y) - lamp.half_height < std::sqrt(sqr(hit.x) + sqr(hit.z)) - lamp.radius;
  if (on_side) return parts.share(1) * side.pdf(from, hit);
  const dvec3 up(0, hit.y > 0 ? 1 : -1, 0);
  return parts.share(0) * area_to_solid_angle({hit, up}, from, kPi * sqr(lamp.radius));
}

double cylinder_distance(const Lamp& lamp, dvec3 p) {
  const double out = std::sqrt(sqr(p.x) + sqr(p.z)) - lamp.radius, up = std::abs(p.y) - lamp.half_height;
  return std::abs(std::min(std::max(out, up), 0.0) + std::sqrt(sqr(std::max(out, 0.0)) + sqr(std::max(up, 0.0))));
}

dvec3 ball_of(const Lamp& lamp, bool upper) { return {0, upper ? lamp.half_height : -lamp.half_height, 0}; }

double capsule_distance(const Lamp& lamp, dvec3 p) {
  return glm::length(p - dvec3(0, std::clamp(p.y, -lamp.half_height, lamp.half_height), 0)) - lamp.radius;
}

// The lower ball, the upper one, the side. Of a ball that is not the nearer end only half is outside the solid.
Parts<3> capsule_parts(const Lamp& lamp, dvec3 from, const Side& side) {
  Parts<3> parts;
  if (!(capsule_distance(lamp, from) > 0)) return parts;
  for (const bool upper : {false, true}) {
    const bool whole = upper ? from.y > lamp.half_height : from.y < -lamp.half_height;
    parts.weights[upper] = (whole ? 2 : 1) * kPi * ball_height(from, ball_of(lamp, upper), lamp.radius);
  }
  parts.weights[2] = side.weight(from);
  return parts;
}

ShapeSample sample_capsule(const Lamp& lamp, dvec3 from, dvec2 u) {
  const Side side(from, lamp.radius, lamp.half_height);
  const Parts<3> parts = capsule_parts(lamp, from, side);
  if (!(parts.sum() > 0)) return {};
  const std::size_t part = parts.choose(u.x);
  ShapeSample out = part == 2 ? side.sample(from, u) : sample_ball(from, ball_of(lamp, part == 1), lamp.radius, u);
  out.pdf *= parts.share(part);
  if (part < 2 && (part == 1 ? out.position.y : -out.position.y) <= lamp.half_height) out.pdf = 0;
  return out;
}

double capsule_pdf(const Lamp& lamp, dvec3 from, dvec3 hit) {
  const Side side(from, lamp.radius, lamp.half_height);
  const Parts<3> parts = capsule_parts(lamp, from, side);
  if (!(parts.sum() > 0)) return 0;
  if (std::abs(hit.y) <= lamp.half_height) return parts.share(2) * side.pdf(from, hit);
  const bool upper = hit.y > 0;
  return parts.share(upper) * ball_pdf(from, ball_of(lamp, upper), lamp.radius);
}

}  // namespace

LampShape::LampShape(const Lamp& lamp) : lamp_(lamp) {
  rectangle_ = lamp.shape == Lamp::Shape::Quad && is_rectangle(lamp);
}

dvec3 LampShape::to_local(dvec3 p) const { return glm::transpose(lamp_.rotation) * (p - lamp_.translation); }

ShapeSample LampShape::sample(dvec3 from, glm::vec2 u) const {
  const dvec3 local = to_local(from);
  ShapeSample out;
  switch (lamp_.shape) {
    case Lamp::Shape::Sphere:
      out = sample_ball(local, dvec3(0), lamp_.radius, dvec2(u));
      break;
    case Lamp::Shape::Box:
      out = sample_box(local, lamp_.half_size, dvec2(u));
      break;
    case Lamp::Shape::Cylinder:
      out = sample_cylinder(lamp_, local, dvec2(u));
      break;
    case Lamp::Shape::Capsule:
      out = sample_capsule(lamp_, local, dvec2(u));
      break;
    case Lamp::Shape::Quad:
      out = sample_quad(lamp_, rectangle_, local, dvec2(u));
  }
  out.position = lamp_.rotation * out.position + lamp_.translation;
  out.normal = lamp_.rotation * out.normal;
  return out;
}

double LampShape::pdf(dvec3 from, dvec3 hit) const {
  const dvec3 p = to_local(from), q = to_local(hit);
  switch (lamp_.shape) {
    case Lamp::Shape::Sphere:
      return ball_pdf(p, dvec3(0), lamp_.radius);
    case Lamp::Shape::Box:
      return box_pdf(p, lamp_.half_size, q);
    case Lamp::Shape::Cylinder:
      return cylinder_pdf(lamp_, p, q);
    case Lamp::Shape::Capsule:
      return capsule_pdf(lamp_, p, q);
    case Lamp::Shape::Quad:
      return quad_pdf(lamp_, rectangle_, p, q);
  }
  return 0;
}

double LampShape::distance(dvec3 place) const {
  const dvec3 p = to_local(place);
  switch (lamp_.shape) {
    case Lamp::Shape::Sphere:
      return std::abs(glm::length(p) - lamp_.radius);
    case Lamp::Shape::Box: {
      const dvec3 out = glm::abs(p) - lamp_.half_size;
      return std::abs(glm::length(glm::max(out, 0.0)) + std::min(std::max({out.x, out.y, out.z}), 0.0));
    }
    case Lamp::Shape::Cylinder:
      return cylinder_distance(lamp_, p);
    case Lamp::Shape::Capsule:
      return std::abs(capsule_distance(lamp_, p));
    case Lamp::Shape::Quad:
      return quad_distance(lamp_, p);
  }
  return INFINITY;
}

double LampShape::radius() const {
  switch (lamp_.shape) {
    case Lamp::Shape::Sphere:
      return lamp_.radius;
    case Lamp::Shape::Box:
      return glm::length(lamp_.half_size);
    case Lamp::Shape::Cylinder:
      return std::sqrt(sqr(lamp_.radius) + sqr(lamp_.half_height));
    case Lamp::Shape::Capsule:
      return lamp_.radius + lamp_.half_height;
    case Lamp::Shape::Quad: {
      double farthest = 0;
      for (const dvec2 corner : lamp_.corners) farthest = std::max(farthest, glm::length(corner));
      return farthest + lamp_.radius;
    }
  }
  return 0;
}

double LampShape::area() const {
  const double r = lamp_.radius, h = lamp_.half_height;
  const dvec3 s = lamp_.half_size;
  switch (lamp_.shape) {
    case Lamp::Shape::Sphere:
      return 4 * kPi * r * r;
    case Lamp::Shape::Box:
      return 8 * (s.x * s.y + s.y * s.z + s.z * s.x);
    case Lamp::Shape::Cylinder:
      return 2 * kPi * r * (r + 2 * h);
    case Lamp::Shape::Capsule:
      return 4 * kPi * r * (r + h);
    case Lamp::Shape::Quad:
      return quad_area(lamp_);
  }
  return 0;
}

}  // namespace fathom::runtime
