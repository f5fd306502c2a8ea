#include "runtime/light/light_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "runtime/base/angle.h"
#include "runtime/light/area_light_sampling.h"
#include "runtime/light/curved_area_lights.h"
#include "runtime/light/spherical_rectangle.h"

namespace fathom::runtime {
namespace {

using compiler::AreaLight;
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
  static SphericalRectangle face(dvec3 from, dvec3 half, int axis) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    return {-half[j] - from[j], half[j] - from[j], -half[k] - from[k], half[k] - from[k],
            std::abs(from[axis]) - half[axis]};
  }
  DiscreteDistribution<3> parts;
};

ShapeSample sample_box(dvec3 from, dvec3 half, dvec2 u) {
  const BoxFaces faces(from, half);
  if (!(faces.parts.sum() > 0)) return {};
  const std::size_t part = faces.parts.sample(u.x);
  const int axis = static_cast<int>(part), j = (axis + 1) % 3, k = (axis + 2) % 3;
  const SphericalRectangle::Sample place = BoxFaces::face(from, half, axis).sample(u);
  ShapeSample out;
  out.normal[axis] = from[axis] > 0 ? 1 : -1;
  out.position[axis] = out.normal[axis] * half[axis];
  out.position[j] = from[j] + place.at.x;
  out.position[k] = from[k] + place.at.y;
  out.pdf = faces.parts.pmf(part) * place.pdf;
  return out;
}

double box_pdf(dvec3 from, dvec3 half, dvec3 hit) {
  int axis = 0;  // of the nearest face
  for (int i = 1; i < 3; ++i) {
    if (std::abs(hit[i]) - half[i] > std::abs(hit[axis]) - half[axis]) axis = i;
  }
  if (!(std::abs(from[axis]) > half[axis]) || (from[axis] > 0) != (hit[axis] > 0)) return 0;
  const int across = (axis + 1) % 3;
  return BoxFaces(from, half).parts.pmf(static_cast<std::size_t>(axis)) *
         BoxFaces::face(from, half, axis).pdf(hit[across] - from[across]);
}

// --- quads

double cross2(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }

double quad_area(const AreaLight& quad) {
  return 0.5 * cross2(quad.corners[2] - quad.corners[0], quad.corners[3] - quad.corners[1]);
}

bool is_rectangle(const AreaLight& quad) {
  constexpr double kTolerance = 1e-9;
  const std::array<dvec2, 4>& c = quad.corners;
  const dvec2 a = c[1] - c[0], b = c[3] - c[0];
  const double size2 = glm::dot(a, a) + glm::dot(b, b);
  return std::abs(glm::dot(a, b)) <= kTolerance * size2 &&
         glm::length(c[2] - c[0] - a - b) <= kTolerance * std::sqrt(size2);
}

bool inside_quad(const AreaLight& quad, dvec2 p) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (cross2(quad.corners[(i + 1) % 4] - quad.corners[i], p - quad.corners[i]) < 0) return false;
  }
  return true;
}

// Returns the face towards `from`. The area light's x axis lies along the first side.
SphericalRectangle face_of(const AreaLight& quad, dvec3 from) {
  const dvec2 lo = quad.corners[0], hi = quad.corners[2];
  return {lo.x - from.x, hi.x - from.x, lo.y - from.y, hi.y - from.y, std::abs(from.z) - quad.radius};
}

ShapeSample sample_quad(const AreaLight& quad, bool rectangle, dvec3 from, dvec2 u) {
  if (!(std::abs(from.z) > quad.radius)) return {};
  const double side = from.z > 0 ? 1 : -1;
  ShapeSample out{dvec3(0, 0, side * quad.radius), dvec3(0, 0, side)};
  if (rectangle) {
    const SphericalRectangle::Sample place = face_of(quad, from).sample(u);
    out.position.x = from.x + place.at.x;
    out.position.y = from.y + place.at.y;
    out.pdf = place.pdf;
    return out;
  }
  const std::array<dvec2, 4>& c = quad.corners;
  const DiscreteDistribution<2> halves{{cross2(c[1] - c[0], c[2] - c[0]), cross2(c[2] - c[0], c[3] - c[0])}};
  const std::size_t half = halves.sample(u.x);
  // Samples a triangle uniformly: Turk, "Generating Random Points in Triangles", Graphics Gems, 1990.
  const double root = std::sqrt(u.x);
  const dvec2 place = (1 - root) * c[0] + root * (1 - u.y) * c[1 + half] + root * u.y * c[2 + half];
  out.position.x = place.x;
  out.position.y = place.y;
  out.pdf = area_to_solid_angle(out, from, quad_area(quad));
  return out;
}

double quad_pdf(const AreaLight& quad, bool rectangle, dvec3 from, dvec3 hit) {
  if (!(std::abs(from.z) > quad.radius) || (from.z > 0) != (hit.z > 0)) return 0;
  if (!inside_quad(quad, dvec2(hit))) return 0;
  if (!rectangle) return area_to_solid_angle({hit, dvec3(0, 0, from.z > 0 ? 1 : -1)}, from, quad_area(quad));
  return face_of(quad, from).pdf(hit.x - from.x);
}

double quad_distance(const AreaLight& quad, dvec3 p) {
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

AreaLightShape::AreaLightShape(const AreaLight& area_light) : area_light_(area_light) {
  rectangle_ = area_light.shape == AreaLight::Shape::Quad && is_rectangle(area_light);
}

dvec3 AreaLightShape::to_local(dvec3 p) const {
  return glm::transpose(area_light_.rotation) * (p - area_light_.translation);
}

ShapeSample AreaLightShape::sample(dvec3 from, glm::vec2 u) const {
  const dvec3 local = to_local(from);
  ShapeSample out;
  switch (area_light_.shape) {
    case AreaLight::Shape::Sphere:
      out = sample_ball(local, dvec3(0), area_light_.radius, dvec2(u));
      break;
    case AreaLight::Shape::Box:
      out = sample_box(local, area_light_.half_size, dvec2(u));
      break;
    case AreaLight::Shape::Cylinder:
      out = sample_cylinder(area_light_, local, dvec2(u));
      break;
    case AreaLight::Shape::Capsule:
      out = sample_capsule(area_light_, local, dvec2(u));
      break;
    case AreaLight::Shape::Quad:
      out = sample_quad(area_light_, rectangle_, local, dvec2(u));
  }
  out.position = area_light_.rotation * out.position + area_light_.translation;
  out.normal = area_light_.rotation * out.normal;
  return out;
}

double AreaLightShape::pdf(dvec3 from, dvec3 hit) const {
  const dvec3 p = to_local(from), q = to_local(hit);
  switch (area_light_.shape) {
    case AreaLight::Shape::Sphere:
      return glm::dot(q, p - q) > 0 ? ball_pdf(p, dvec3(0), area_light_.radius) : 0;
    case AreaLight::Shape::Box:
      return box_pdf(p, area_light_.half_size, q);
    case AreaLight::Shape::Cylinder:
      return cylinder_pdf(area_light_, p, q);
    case AreaLight::Shape::Capsule:
      return capsule_pdf(area_light_, p, q);
    case AreaLight::Shape::Quad:
      return quad_pdf(area_light_, rectangle_, p, q);
  }
  return 0;
}

double AreaLightShape::distance(dvec3 place) const {
  const dvec3 p = to_local(place);
  switch (area_light_.shape) {
    case AreaLight::Shape::Sphere:
      return std::abs(glm::length(p) - area_light_.radius);
    case AreaLight::Shape::Box: {
      const dvec3 out = glm::abs(p) - area_light_.half_size;
      return std::abs(glm::length(glm::max(out, 0.0)) + std::min(std::max({out.x, out.y, out.z}), 0.0));
    }
    case AreaLight::Shape::Cylinder:
      return cylinder_distance(area_light_, p);
    case AreaLight::Shape::Capsule:
      return std::abs(capsule_distance(area_light_, p));
    case AreaLight::Shape::Quad:
      return quad_distance(area_light_, p);
  }
  return INFINITY;
}

double AreaLightShape::radius() const {
  switch (area_light_.shape) {
    case AreaLight::Shape::Sphere:
      return area_light_.radius;
    case AreaLight::Shape::Box:
      return glm::length(area_light_.half_size);
    case AreaLight::Shape::Cylinder:
      return std::sqrt(sqr(area_light_.radius) + sqr(area_light_.half_height));
    case AreaLight::Shape::Capsule:
      return area_light_.radius + area_light_.half_height;
    case AreaLight::Shape::Quad: {
      double farthest = 0;
      for (const dvec2 corner : area_light_.corners) farthest = std::max(farthest, glm::length(corner));
      return farthest + area_light_.radius;
    }
  }
  return 0;
}

double AreaLightShape::area() const {
  const double r = area_light_.radius, h = area_light_.half_height;
  const dvec3 s = area_light_.half_size;
  switch (area_light_.shape) {
    case AreaLight::Shape::Sphere:
      return 4 * kPi * r * r;
    case AreaLight::Shape::Box:
      return 8 * (s.x * s.y + s.y * s.z + s.z * s.x);
    case AreaLight::Shape::Cylinder:
      return 2 * kPi * r * (r + 2 * h);
    case AreaLight::Shape::Capsule:
      return 4 * kPi * r * (r + h);
    case AreaLight::Shape::Quad:
      return quad_area(area_light_);
  }
  return 0;
}

}  // namespace fathom::runtime
