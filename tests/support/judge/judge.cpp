#include "tests/support/judge/judge.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "compiler/shapes/node_table.h"
#include "tests/support/judge/judge_domain.h"
#include "tests/support/judge/judge_geometry.h"
#include "tests/support/judge/judge_noise.h"
#include "tests/support/judge/judge_outlines.h"
#include "vm/program/check.h"

namespace fathom::test {
namespace {

using compiler::Graph;
using compiler::Kind;
using compiler::NodeId;
using glm::dvec2;
using glm::dvec3;


dvec2 half_plane(dvec3 p) { return {std::hypot(p.x, p.z), p.y}; }

// Solid of revolution with a straight profile from (bottom, -h) to (top, h). Its boundary is three segments of the
// half-plane. A point is inside when it lies between the caps and nearer to the axis than the slanted line.
double frustum(dvec3 p, double bottom, double top, double h) {
  const dvec2 q = half_plane(p);
  const double to_boundary = std::min({distance_to_segment(q, dvec2(0, -h), dvec2(bottom, -h)),
                                       distance_to_segment(q, dvec2(bottom, -h), dvec2(top, h)),
                                       distance_to_segment(q, dvec2(top, h), dvec2(0, h))});
  const double at = (q.y + h) / (2 * h);
  const bool inside = std::abs(q.y) < h && q.x < bottom + at * (top - bottom);
  return inside ? -to_boundary : to_boundary;
}

// All points within `minor` of the circle of radius `major` around the y axis (the definition of a torus). The
// nearest point of the circle has p's azimuth. From the axis all points of the circle are equally near.
double torus(dvec3 p, double major, double minor) {
  const double rho = std::hypot(p.x, p.z);
  const dvec3 nearest = rho > 0 ? dvec3(p.x / rho * major, 0, p.z / rho * major) : dvec3(major, 0, 0);
  return glm::length(p - nearest) - minor;
}

// Union of the balls of centre (0, t h, 0) and radius bottom + t (top - bottom), t in [0,1]. The distance is the
// minimum of g(t) = sqrt(rho^2 + (y - t h)^2) - radius(t). g is convex, and g' = 0 where (y - t h) / |p - c| = s with
// s = (bottom - top) / h, that is y - t h = rho s / sqrt(1 - s^2). For |s| >= 1 g is monotonic. The normals of the
// balls' envelope pass through the balls' centres, so the same minimum is exact inside.
double round_cone(dvec3 p, double bottom, double top, double h) {
  const dvec2 q = half_plane(p);
  const double s = (bottom - top) / h;
  double t = s > 0 ? 0.0 : 1.0;
  if (std::abs(s) < 1) t = std::clamp((q.y - q.x * s / std::sqrt((1 - s) * (1 + s))) / h, 0.0, 1.0);
  return std::hypot(q.x, q.y - t * h) - (bottom + t * (top - bottom));
}

// Distance estimate 0.5 ln|w| |w| / |w'| of the escaping orbit of w -> w^n + p in White and Nylander's triplex
// algebra, polar axis y. The derivative's length follows |w'| -> n |w|^(n-1) |w'| + 1. Source: Hart, Sandin,
// Kauffman, "Ray Tracing Deterministic 3-D Fractals", 1989, equation 8, with ln|w| = ln(|w|^2) / 2. Far out the
// estimate grows like |p| ln|p|, so the distance to the ball of radius 2^(1/(n-1)) limits it: outside that ball |w^n
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
  if (compiler::spec(kind).sort == compiler::Sort::Outline) return judge_outline(kind, k, dvec2(p));
  switch (kind) {
    case Kind::Sphere:
      return std::hypot(p.x, p.y, p.z) - k[0];
    case Kind::Box:
      return distance_to_box(p, vec3_at(k, 0));
    case Kind::RoundBox:
      return distance_to_box(p, vec3_at(k, 0) - k[3]) - k[3];  // all points within `radius` of an inner box
    case Kind::Torus:
      return torus(p, k[0], k[1]);
    case Kind::Plane:
      return glm::dot(p, vec3_at(k, 0)) / std::hypot(k[0], k[1], k[2]) - k[3];
    case Kind::Cylinder:
      return frustum(p, k[0], k[0], k[1]);
    case Kind::RoundedCylinder:
      return frustum(p, k[0] - k[2], k[0] - k[2], k[1] - k[2]) - k[2];
    case Kind::Cone:
      return frustum(p, k[0], k[1], k[2]);
    case Kind::RoundCone:
      return round_cone(p, k[0], k[1], k[2]);
    case Kind::Triangle:
      return distance_to_polygon(p, {vec3_at(k, 0), vec3_at(k, 3), vec3_at(k, 6)}) - k[9];
    case Kind::Quad:
      return distance_to_polygon(p, {vec3_at(k, 0), vec3_at(k, 3), vec3_at(k, 6), vec3_at(k, 9)}) - k[12];
    case Kind::Mandelbulb:
      return mandelbulb(p, k[0], static_cast<int>(k[1]), k[2]) - k[3];
    default: {
      const std::optional<double> distance = judge_solid(kind, k, p);
      CHECK(distance.has_value(), "a primitive");
      return *distance;
    }
  }
}

// Innermost paint around a node, and the evaluated point in the coordinates of that paint.
struct Coat {
  std::uint32_t surface;
  dvec3 place;
};

Verdict visit(const Graph& graph, NodeId node, dvec3 p, const Coat& coat);

// Value of a formula's node: libm's functions of the operands, which may be distances.
double judge_number(const Graph& graph, NodeId node, dvec3 p) {
  const auto operands = graph.children(node);
  const auto operand = [&](std::size_t i) { return visit(graph, operands[i], p, {0, p}).distance; };
  const double a = operands.empty() ? 0 : operand(0), b = operands.size() < 2 ? 0 : operand(1);
  const auto quotient = [&] { return a - b * std::floor(a / b); };
  switch (graph.kind(node)) {
    case Kind::X:
      return p.x;
    case Kind::Y:
      return p.y;
    case Kind::Z:
      return p.z;
    case Kind::Constant:
      return graph.params(node)[0];
    case Kind::Negate:
      return -a;
    case Kind::Abs:
      return std::abs(a);
    case Kind::Square:
      return a * a;
    case Kind::Sqrt:
      return std::sqrt(a);
    case Kind::Sin:
      return std::sin(a);
    case Kind::Cos:
      return std::cos(a);
    case Kind::Tan:
      return std::tan(a);
    case Kind::Asin:
      return std::asin(std::clamp(a, -1.0, 1.0));
    case Kind::Acos:
      return std::acos(std::clamp(a, -1.0, 1.0));
    case Kind::Atan:
      return std::atan(a);
    case Kind::Exp:
      return std::exp(a);
    case Kind::Log:
      return std::log(a);
    case Kind::Floor:
      return std::floor(a);
    case Kind::Ceil:
      return std::ceil(a);
    case Kind::Nearest:
      return std::nearbyint(a);
    case Kind::Sign:
      return a > 0 ? 1 : a < 0 ? -1 : 0;
    case Kind::Not:
      return a == 0 ? 1 : 0;
    case Kind::Add:
      return a + b;
    case Kind::Minus:
      return a - b;
    case Kind::Multiply:
      return a * b;
    case Kind::Divide:
      return a / b;
    case Kind::Modulo:
      return quotient();
    case Kind::ModuloEuclid:
      return a - std::abs(b) * std::floor(a / std::abs(b));
    case Kind::Minimum:
      return std::min(a, b);
    case Kind::Maximum:
      return std::max(a, b);
    case Kind::Atan2:
      return std::atan2(a, b);
    case Kind::Power:
      return std::pow(a, b);
    case Kind::Compare:
      return a < b ? -1 : a > b ? 1 : 0;
    case Kind::And:
      return a == 0 ? a : b;
    case Kind::Or:
      return a == 0 ? b : a;
    case Kind::Step:
      return b < a ? 0 : 1;
    case Kind::Noise:
      return judge_noise({a, b, operand(2)});
    default:
      CHECK(false, "a function");
      return 0;
  }
}

// Blend of a and b: the minimum of h a + (1-h) b - k h (1-h) over the weights h in [0,1]. The expression is a
// parabola in h with its minimum at h = 1/2 + (b-a) / (2k); k = 0 gives min(a, b). Known as the quadratic polynomial
// smooth minimum (Quilez, "Smooth minimum", 2013).
double blend(double a, double b, double k) {
  if (k == 0) return std::min(a, b);
  const double h = std::clamp(0.5 + (b - a) / (2 * k), 0.0, 1.0);
  return h * a + (1 - h) * b - k * h * (1 - h);
}

// Stairs from (r, 0) to (0, r) in the quadrant of the two distances: `steps` + 1 teeth with corners on a + b = r. The
// surface is a saw-tooth about that line whose edges are parallel to the a and b axes.
double stairs(double a, double b, double r, double steps) {
  const double step = r / steps, along = std::abs(b - a) - r + step;
  const double tooth = std::abs(along - 2 * step * std::floor(along / (2 * step)) - step);
  return std::min({a, b, (a + b - r + tooth) / 2});
}

// How a combinator joins two operands; Hard is the plain union.
enum class Join { Hard, Smooth, Chamfer, Round, Stairs };

double joined(Join join, double a, double b, Params k) {
  if (join == Join::Hard || k[0] == 0) return std::min(a, b);
  switch (join) {
    case Join::Smooth:
      return blend(a, b, k[0]);
    case Join::Chamfer:  // the plane a + b = r, where that is lower
      return std::min(std::min(a, b), (a + b - k[0]) / 2);
    case Join::Round: {  // the circle of radius r about (r, r), where both distances are below r
      if (a < k[0] && b < k[0]) return k[0] - std::hypot(k[0] - a, k[0] - b);
      return std::min(a, b);
    }
    default:
      return stairs(a, b, k[0], k[1]);
  }
}

struct Combination {
  Join join;
  // complement: the operands are complemented. subtract: all operands except the first stay as they are.
  bool complement, subtract;
};
Combination combination(Kind kind) {
  const auto offset = [kind](Kind first) { return static_cast<int>(kind) - static_cast<int>(first); };
  const auto of = [](Join join, int which) { return Combination{join, which != 0, which == 2}; };
  if (kind <= Kind::Subtraction) return of(Join::Hard, offset(Kind::Union));
  if (kind <= Kind::SmoothSubtraction) return of(Join::Smooth, offset(Kind::SmoothUnion));
  if (kind <= Kind::ChamferSubtraction) return of(Join::Chamfer, offset(Kind::ChamferUnion));
  if (kind <= Kind::RoundSubtraction) return of(Join::Round, offset(Kind::RoundUnion));
  return of(Join::Stairs, offset(Kind::StairsUnion));
}

// Distance of the exclusive or of two operands. Points inside an odd number of operands are inside.
double xor_of(double a, double b) { return std::max(std::min(a, b), -std::max(a, b)); }

// Every other combinator is a joined union of its operands or of their complements. A intersected with B is the
// complement of the union of the complements; A minus B is the intersection of A with B's complement. All fold from
// the left.
Verdict combinator(const Graph& graph, NodeId node, dvec3 p, const Coat& coat) {
  const Kind kind = graph.kind(node);
  const Params params = graph.params(node);
  const bool special = kind == Kind::Xor || kind == Kind::Morph;
  const Combination c = special ? Combination{Join::Hard, false, false} : combination(kind);
  const double k = c.join == Join::Hard ? 0.0 : params[0];
  Verdict sum{0, coat.surface, kInfinity, coat.place};
  const std::span<const NodeId> children = graph.children(node);
  for (std::size_t i = 0; i < children.size(); ++i) {
    Verdict next = visit(graph, children[i], p, coat);
    if (c.complement && !(c.subtract && i > 0)) next.distance = -next.distance;
    if (i == 0) {
      sum = next;
      continue;
    }
    const double a = sum.distance, b = next.distance, gap = std::abs(b - a);
    if (special) {
      const double margin = std::min({sum.margin, next.margin, gap, std::abs(a + b)});
      // The winner of an xor is the operand that gives the distance: the smaller distance, or the larger one negated.
      const bool second = kind == Kind::Xor && ((a + b > 0) == (b < a));
      const double value = kind == Kind::Xor ? xor_of(a, b) : (1 - params[0]) * a + params[0] * b;
      sum = {value, second ? next.surface : sum.surface, margin, second ? next.place : sum.place};
      continue;
    }
    const double to_edge_of_blend = k > 0 ? std::abs(gap - k) : kInfinity;
    const Verdict& winner = b < a ? next : sum;
    sum = {joined(c.join, a, b, params), winner.surface,
           std::min({k > 0 ? std::min(sum.margin, next.margin) : winner.margin, gap, to_edge_of_blend}),
           winner.place};
  }
  if (c.complement) sum.distance = -sum.distance;
  return sum;
}

Verdict alteration(const Graph& graph, NodeId node, dvec3 p, const Coat& coat) {
  const Kind kind = graph.kind(node);
  const Params k = graph.params(node);
  const NodeId child = graph.children(node)[0];
  if (kind == Kind::Revolve && k[1] != 0 &&
      compiler::spec(graph.kind(child)).category == compiler::Category::Primitive) {
    return {judge_turned_outline(graph.kind(child), graph.params(child), k[0], half_plane(p)), coat.surface,
            kInfinity, coat.place};
  }
  Verdict least{kInfinity, coat.surface, kInfinity, coat.place};
  for (const dvec3& q : child_points(kind, k, p)) {
    Verdict next = visit(graph, graph.children(node)[0], q, coat);
    const double gap = std::abs(next.distance - least.distance);
    if (next.distance < least.distance) std::swap(next, least);
    least.margin = std::min(least.margin, gap);
  }
  const double value = altered(kind, k, p, least.distance);
  const bool folds = kind == Kind::Onion || kind == Kind::Complement;
  // When the lower bound for omitted copies or omitted space decides, the value belongs to no surface.
  const bool limited = kind == Kind::Repetition || kind == Kind::PolarRepetition || kind == Kind::Bend;
  if (limited && value != least.distance) least.margin = 0;
  const double margin = folds ? std::min(least.margin, std::abs(least.distance)) : least.margin;
  return {value, least.surface, margin, least.place};
}

Verdict visit(const Graph& graph, NodeId node, dvec3 p, const Coat& coat) {
  const Kind kind = graph.kind(node);
  const compiler::Category category = compiler::spec(kind).category;
  if (category == compiler::Category::Primitive) {
    return {primitive(kind, graph.params(node), p), coat.surface, kInfinity, coat.place};
  }
  if (category == compiler::Category::Combinator) return combinator(graph, node, p, coat);
  if (kind == Kind::Displaced) {
    Verdict sum = visit(graph, graph.children(node)[0], p, coat);
    sum.distance += visit(graph, graph.children(node)[1], p, coat).distance;
    return sum;
  }
  if (category == compiler::Category::Function) {
    return {judge_number(graph, node, p), coat.surface, kInfinity, coat.place};
  }
  if (kind != Kind::Paint) return alteration(graph, node, p, coat);
  return alteration(graph, node, p, {static_cast<std::uint32_t>(graph.params(node)[0]), p});
}

}  // namespace

Verdict judge(const Graph& graph, NodeId node, dvec3 p) { return visit(graph, node, p, {0, p}); }
double judge_distance(const Graph& graph, NodeId node, dvec3 p) { return judge(graph, node, p).distance; }
std::uint32_t judge_surface(const Graph& graph, NodeId node, dvec3 p) { return judge(graph, node, p).surface; }

}  // namespace fathom::test
