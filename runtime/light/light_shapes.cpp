#include "runtime/light/light_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "runtime/base/angle.h"
#include "runtime/light/lamp_parts.h"
#include "runtime/light/round_lamps.h"
#include "runtime/light/seen_rectangle.h"

namespace fathom::runtime {
namespace {

using compiler::Lamp;
using glm::dvec2;
using glm::dvec3;

// --- boxes

// The face across each axis on the side of `from`, with weight 0 if `from` is within the box's slab. The weights are
// near the solid angles, up to the half sphere's. Only the density on the chosen face has to be exact.
struct BoxFaces {
  BoxFaces(dvec3 from, dvec3 half) {
    for (int i = 0; i < 3; ++i) {
      const double z = std::abs(from[i]) - half[i];
      if (!(z > 0)) continue;
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const double d2 = z * z + from[j] * from[j] + from[k] * from[k], flat = 4 * half[j] * half[k] * z;
      parts.weights[static_cast<std::size_t>(i)] = 1 / (d2 * std::sqrt(d2) / flat + 1 / (2 * kPi));
    }
  }
  static SeenRectangle face(dvec3 from, dvec3 half, int axis) {
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
  const SeenRectangle::Place place = BoxFaces::face(from, half, axis).sample(u);
  ShapeSample out;
  out.normal[axis] = from[axis] > 0 ? 1 : -1;
  out.position[axis] = out.normal[axis] * half[axis];
  out.position[j] = from[j] + place.at.x;
  out.position[k] = from[k] + place.at.y;
  out.pdf = faces.parts.share(part) * place.pdf;
  return out;
}

double box_pdf(dvec3 from, dvec3 half, dvec3 hit) {
  int axis = 0;  // of the nearest face
  for (int i = 1; i < 3; ++i) {
    if (std::abs(hit[i]) - half[i] > std::abs(hit[axis]) - half[axis]) axis = i;
  }
  if (!(std::abs(from[axis]) > half[axis]) || (from[axis] > 0) != (hit[axis] > 0)) return 0;
  const int across = (axis + 1) % 3;
  return BoxFaces(from, half).parts.share(static_cast<std::size_t>(axis)) *
         BoxFaces::face(from, half, axis).pdf(hit[across] - from[across]);
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

// Returns the face towards `from`. The lamp's x axis lies along the first side.
SeenRectangle face_of(const Lamp& quad, dvec3 from) {
  const dvec2 lo = quad.corners[0], hi = quad.corners[2];
  return {lo.x - from.x, hi.x - from.x, lo.y - from.y, hi.y - from.y, std::abs(from.z) - quad.radius};
}

ShapeSample sample_quad(const Lamp& quad, bool rectangle, dvec3 from, dvec2 u) {
  if (!(std::abs(from.z) > quad.radius)) return {};
  const double side = from.z > 0 ? 1 : -1;
  ShapeSample out{dvec3(0, 0, side * quad.radius), dvec3(0, 0, side)};
  if (rectangle) {
    const SeenRectangle::Place place = face_of(quad, from).sample(u);
    out.position.x = from.x + place.at.x;
    out.position.y = from.y + place.at.y;
    out.pdf = place.pdf;
    return out;
  }
  const std::array<dvec2, 4>& c = quad.corners;
  const Parts<2> halves{{cross2(c[1] - c[0], c[2] - c[0]), cross2(c[2] - c[0], c[3] - c[0])}};
  const std::size_t half = halves.choose(u.x);
  // Samples a triangle uniformly: Turk, "Generating Random Points in Triangles", Graphics Gems, 1990.
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
  return face_of(quad, from).pdf(hit.x - from.x);
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
      return glm::dot(q, p - q) > 0 ? ball_pdf(p, dvec3(0), lamp_.radius) : 0;
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
