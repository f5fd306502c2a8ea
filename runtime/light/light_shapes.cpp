#include "runtime/light/light_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "runtime/base/angle.h"
#include "runtime/light/area_light_sampling.h"
#include "runtime/light/curved_area_lights.h"

namespace fathom::runtime {
namespace {

using compiler::AreaLight;
using glm::dvec2;
using glm::dvec3;

// --- boxes, and rectangles as boxes of which two faces are sampled

BoxLight box_of(const AreaLight& area_light) {
  const bool box = area_light.shape == AreaLight::Shape::Box;
  const dvec3 lo = box ? -area_light.half_size : dvec3(area_light.corners[0], -area_light.radius);
  const dvec3 hi = box ? area_light.half_size : dvec3(area_light.corners[2], area_light.radius);
  return {area_light.rotation, area_light.translation, lo, hi, box ? dvec3(1) : dvec3(0, 0, 1)};
}

ShapeSample sample_box(const BoxLight& box, dvec3 from, dvec2 u) {
  BoxLightRows rows;
  rows.set(0, 0, from);
  rows.u[0] = u.x;
  rows.v[0] = u.y;
  sample_box_lights({&box, 1}, 1, rows);
  const dvec3 way = rows.way_of(0), axis = box.rotation[static_cast<int>(rows.axis[0])];
  return {from + way, glm::dot(axis, way) < 0 ? axis : -axis, rows.pdf[0]};
}

double box_pdf(const BoxLight& box, dvec3 from, dvec3 hit) {
  BoxLightRows rows;
  rows.set(0, 0, from);
  for (int k = 0; k < 3; ++k) rows.way[k][0] = hit[k] - from[k];
  set_box_light_pdfs({&box, 1}, 1, rows);
  return rows.pdf[0];
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

ShapeSample sample_quad(const AreaLight& quad, dvec3 from, dvec2 u) {
  if (!(std::abs(from.z) > quad.radius)) return {};
  const double side = from.z > 0 ? 1 : -1;
  ShapeSample out{dvec3(0, 0, side * quad.radius), dvec3(0, 0, side)};
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

double quad_pdf(const AreaLight& quad, dvec3 from, dvec3 hit) {
  if (!(std::abs(from.z) > quad.radius) || (from.z > 0) != (hit.z > 0)) return 0;
  if (!inside_quad(quad, dvec2(hit))) return 0;
  return area_to_solid_angle({hit, dvec3(0, 0, from.z > 0 ? 1 : -1)}, from, quad_area(quad));
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
  const bool quad = area_light.shape == AreaLight::Shape::Quad;
  if (quad ? is_rectangle(area_light) : area_light.shape == AreaLight::Shape::Box) box_ = box_of(area_light);
}

dvec3 AreaLightShape::to_local(dvec3 p) const {
  return glm::transpose(area_light_.rotation) * (p - area_light_.translation);
}

ShapeSample AreaLightShape::sample(dvec3 from, glm::vec2 u) const {
  if (box_) return sample_box(*box_, from, dvec2(u));
  const dvec3 local = to_local(from);
  ShapeSample out;
  switch (area_light_.shape) {
    case AreaLight::Shape::Sphere:
      out = sample_ball(local, dvec3(0), area_light_.radius, dvec2(u));
      break;
    case AreaLight::Shape::Cylinder:
      out = sample_cylinder(area_light_, local, dvec2(u));
      break;
    case AreaLight::Shape::Capsule:
      out = sample_capsule(area_light_, local, dvec2(u));
      break;
    case AreaLight::Shape::Box:
    case AreaLight::Shape::Quad:
      out = sample_quad(area_light_, local, dvec2(u));
  }
  out.position = area_light_.rotation * out.position + area_light_.translation;
  out.normal = area_light_.rotation * out.normal;
  return out;
}

double AreaLightShape::pdf(dvec3 from, dvec3 hit) const {
  if (box_) return box_pdf(*box_, from, hit);
  const dvec3 p = to_local(from), q = to_local(hit);
  switch (area_light_.shape) {
    case AreaLight::Shape::Sphere:
      return glm::dot(q, p - q) > 0 ? ball_pdf(p, dvec3(0), area_light_.radius) : 0;
    case AreaLight::Shape::Cylinder:
      return cylinder_pdf(area_light_, p, q);
    case AreaLight::Shape::Capsule:
      return capsule_pdf(area_light_, p, q);
    case AreaLight::Shape::Box:
    case AreaLight::Shape::Quad:
      return quad_pdf(area_light_, p, q);
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
