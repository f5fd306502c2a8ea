#include "tests/support/judge.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <span>

#include "compiler/shapes/node_table.h"
#include "tests/support/judge_geometry.h"
#include "vm/check.h"

namespace fathom::test {
namespace {

using compiler::Graph;
using compiler::Kind;
using compiler::NodeId;
using glm::dvec2;
using glm::dvec3;
using Params = std::span<const double>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

dvec3 vec(Params k, std::size_t first) { return {k[first], k[first + 1], k[first + 2]}; }
dvec2 half_plane(dvec3 p) { return {std::hypot(p.x, p.z), p.y}; }

// A solid of revolution with a straight profile from (bottom, -h) to (top, h): its boundary is three segments of the
// half-plane, and a point is inside when it lies between the caps and nearer to the axis than the slanted line.
double frustum(dvec3 p, double bottom, double top, double h) {
  const dvec2 q = half_plane(p);
  const double to_boundary = std::min({distance_to_segment(q, dvec2(0, -h), dvec2(bottom, -h)),
                                       distance_to_segment(q, dvec2(bottom, -h), dvec2(top, h)),
                                       distance_to_segment(q, dvec2(top, h), dvec2(0, h))});
  const double at = (q.y + h) / (2 * h);
  const bool inside = std::abs(q.y) < h && q.x < bottom + at * (top - bottom);
  return inside ? -to_boundary : to_boundary;
}

// The points within `minor` of the circle of radius `major` around the y axis (the definition of a torus). The
// nearest point of the circle has p's azimuth; on the axis every point of it is equally near.
double torus(dvec3 p, double major, double minor) {
  const double rho = std::hypot(p.x, p.z);
  const dvec3 nearest = rho > 0 ? dvec3(p.x / rho * major, 0, p.z / rho * major) : dvec3(major, 0, 0);
  return glm::length(p - nearest) - minor;
}

// The union of the balls of centre (0, t h, 0) and radius bottom + t (top - bottom), t in [0,1]; the distance is the
// least of g(t) = sqrt(rho^2 + (y - t h)^2) - radius(t). g is convex, and g' = 0 where (y - t h) / |p - c| = s with
// s = (bottom - top) / h, that is y - t h = rho s / sqrt(1 - s^2). For |s| >= 1 g is monotonous. The balls' envelope
// has its normals through their centres, so the same minimum is exact inside.
double round_cone(dvec3 p, double bottom, double top, double h) {
  const dvec2 q = half_plane(p);
  const double s = (bottom - top) / h;
  double t = s > 0 ? 0.0 : 1.0;
  if (std::abs(s) < 1) t = std::clamp((q.y - q.x * s / std::sqrt((1 - s) * (1 + s))) / h, 0.0, 1.0);
  return std::hypot(q.x, q.y - t * h) - (bottom + t * (top - bottom));
}

// Distance estimate 0.5 ln|w| |w| / |w'| of the escaping orbit of w -> w^n + p in White and Nylander's triplex
// algebra, polar axis y; the derivative's length follows |w'| -> n |w|^(n-1) |w'| + 1. Source: Hart, Sandin,
// Kauffman, "Ray Tracing Deterministic 3-D Fractals", 1989, equation 8, with ln|w| = ln(|w|^2) / 2. Far out, where
// the estimate grows like |p| ln|p|, the distance to the ball of radius 2^(1/(n-1)) limits it: beyond that ball |w^n
// + p| >= |p|^n - |p| > |p|, so every orbit escapes.
double mandelbulb(dvec3 p, double power, int iterations, double bailout) {
  dvec3 w = p;
  double r = glm::length(w), derivative = 1;
  for (int i = 0; i < iterations && r <= bailout; ++i) {
    const double polar = power * std::atan2(std::hypot(w.x, w.z), w.y);
    const double azimuth = power * std::atan2(w.x, w.z);
    derivative = power * std::pow(r, power - 1) * derivative + 1;
    w = p + std::pow(r, power) *
                dvec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth));
    r = glm::length(w);
  }
  const double estimate = r > 0 ? 0.5 * std::log(r) * r / derivative : 0.0;
  const double bound = std::pow(2.0, 1 / (power - 1)), from_origin = glm::length(p);
  return from_origin > 2 * bound ? std::min(estimate, from_origin - bound) : estimate;
}

double primitive(Kind kind, Params k, dvec3 p) {
  switch (kind) {
    case Kind::Sphere:
      return std::hypot(p.x, p.y, p.z) - k[0];
    case Kind::Box:
      return distance_to_box(p, vec(k, 0));
    case Kind::RoundBox:
      return distance_to_box(p, vec(k, 0) - k[3]) - k[3];  // an inner box, all within `radius` of it
    case Kind::Torus:
      return torus(p, k[0], k[1]);
    case Kind::Plane:
      return glm::dot(p, vec(k, 0)) / std::hypot(k[0], k[1], k[2]) - k[3];
    case Kind::Cylinder:
      return frustum(p, k[0], k[0], k[1]);
    case Kind::RoundedCylinder:
      return frustum(p, k[0] - k[2], k[0] - k[2], k[1] - k[2]) - k[2];
    case Kind::Cone:
      return frustum(p, k[0], k[1], k[2]);
    case Kind::RoundCone:
      return round_cone(p, k[0], k[1], k[2]);
    case Kind::Triangle:
      return distance_to_polygon(p, {vec(k, 0), vec(k, 3), vec(k, 6)}) - k[9];
    case Kind::Quad:
      return distance_to_polygon(p, {vec(k, 0), vec(k, 3), vec(k, 6), vec(k, 9)}) - k[12];
    case Kind::Mandelbulb:
      return mandelbulb(p, k[0], static_cast<int>(k[1]), k[2]) - k[3];
    default: {
      const std::optional<double> distance = judge_solid(kind, k, p);
      CHECK(distance.has_value(), "a primitive");
      return *distance;
    }
  }
}

Verdict visit(const Graph& graph, NodeId node, dvec3 p, std::uint32_t paint);

// The row-major 3x4 matrix takes p to the child's space; the child's distance shrinks by the factor.
Verdict transform(const Graph& graph, NodeId node, dvec3 p, std::uint32_t paint) {
  const Params k = graph.params(node);
  const dvec3 q(glm::dot(vec(k, 0), p) + k[3], glm::dot(vec(k, 4), p) + k[7], glm::dot(vec(k, 8), p) + k[11]);
  const double factor = k[12];
  const Verdict child = visit(graph, graph.children(node)[0], q, paint);
  return {child.distance * factor, child.surface, child.margin * std::abs(factor)};
}

// The blend of a and b: the least of h a + (1-h) b - k h (1-h) over the weights h in [0,1]. It is a parabola in h
// with its minimum at h = 1/2 + (b-a) / (2k); k = 0 leaves the lesser of a and b. Known as the quadratic polynomial
// smooth minimum (Quilez, "Smooth minimum", 2013).
double blend(double a, double b, double k) {
  if (k == 0) return std::min(a, b);
  const double h = std::clamp(0.5 + (b - a) / (2 * k), 0.0, 1.0);
  return h * a + (1 - h) * b - k * h * (1 - h);
}

// Every combinator is a blended union of its operands or of their complements: A intersected with B is the complement
// of the union of the complements, A minus B the intersection of A with B's complement. Smooth ones fold from the
// left.
Verdict combinator(const Graph& graph, NodeId node, dvec3 p, std::uint32_t paint) {
  const Kind kind = graph.kind(node);
  const bool smooth =
      kind == Kind::SmoothUnion || kind == Kind::SmoothIntersection || kind == Kind::SmoothSubtraction;
  const bool complement = kind != Kind::Union && kind != Kind::SmoothUnion;
  const bool subtract = kind == Kind::Subtraction || kind == Kind::SmoothSubtraction;
  const double k = smooth ? graph.params(node)[0] : 0.0;
  Verdict sum{0, paint, kInfinity};
  const std::span<const NodeId> children = graph.children(node);
  for (std::size_t i = 0; i < children.size(); ++i) {
    Verdict next = visit(graph, children[i], p, paint);
    if (complement && !(subtract && i > 0)) next.distance = -next.distance;
    if (i == 0) {
      sum = next;
      continue;
    }
    const double gap = std::abs(next.distance - sum.distance);
    const double to_edge_of_blend = k > 0 ? std::abs(gap - k) : kInfinity;
    const Verdict& winner = next.distance < sum.distance ? next : sum;
    sum = {blend(sum.distance, next.distance, k), winner.surface,
           std::min({k > 0 ? std::min(sum.margin, next.margin) : winner.margin, gap, to_edge_of_blend})};
  }
  if (complement) sum.distance = -sum.distance;
  return sum;
}

Verdict visit(const Graph& graph, NodeId node, dvec3 p, std::uint32_t paint) {
  const Kind kind = graph.kind(node);
  const compiler::Category category = compiler::spec(kind).category;
  if (category == compiler::Category::Primitive) return {primitive(kind, graph.params(node), p), paint, kInfinity};
  if (category == compiler::Category::Combinator) return combinator(graph, node, p, paint);
  if (kind == Kind::Transform) return transform(graph, node, p, paint);
  const double k = graph.params(node)[0];
  const NodeId child = graph.children(node)[0];
  if (kind == Kind::Paint) return visit(graph, child, p, static_cast<std::uint32_t>(k));
  Verdict inner = visit(graph, child, p, paint);
  if (kind == Kind::Round) return {inner.distance - k, inner.surface, inner.margin};
  CHECK(kind == Kind::Onion, "the last kind");
  return {std::abs(inner.distance) - k, inner.surface, std::min(inner.margin, std::abs(inner.distance))};
}

}  // namespace

Verdict judge(const Graph& graph, NodeId node, dvec3 p) { return visit(graph, node, p, 0); }
double judge_distance(const Graph& graph, NodeId node, dvec3 p) { return judge(graph, node, p).distance; }
std::uint32_t judge_surface(const Graph& graph, NodeId node, dvec3 p) { return judge(graph, node, p).surface; }

}  // namespace fathom::test
