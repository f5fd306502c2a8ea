// Rows of the domain operators that fold and bend the space in which a child is evaluated. repetition.cpp has those
// that repeat space.
//
// Each operator keeps three promises whatever the child: its zero set is the folded, repeated or bent solid; it
// changes nowhere faster than its Lipschitz constant; outside the solid it never exceeds that constant times the
// distance. The operators can keep them because they know the child's box beforehand. Two techniques recur:
//
//   meet   The map is evaluated at the nearest point of a convex region K that contains the solid (clamp_tube,
//          clamp_box), where the map's slope is bounded, and the distance to K is added at a right angle. Let q be
//          the point of K nearest to p, and s any point of K: the angle at q is at least a right angle, so
//          |p - s|^2 >= |p - q|^2 + |q - s|^2.
//   limit  Only the copies near p are evaluated, even if there is no end of copies. The distance to the others, known
//          from the child's box, bounds the result from above. The limit is chosen so that nothing jumps where the
//          set of evaluated copies changes: there the limit equals the smallest possible distance of these copies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "compiler/geometry/affine.h"
#include "compiler/geometry/direction.h"
#include "compiler/shapes/about_axis.h"
#include "compiler/shapes/make_node.h"
#include "compiler/shapes/rows.h"
#include "vm/number/real.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

constexpr double kRadians = std::numbers::pi / 180;

// Returns the largest singular value of [[a, b], [0, c]], the largest stretch of the map (x, y) -> (a x + b y, c y).
double largest_stretch(double a, double b, double c) {
  const double sum = a * a + b * b + c * c, determinant = a * c;
  return std::sqrt((sum + std::sqrt(std::max(0.0, sum * sum - 4 * determinant * determinant))) / 2);
}

glm::dvec3 normal_of(Params p) { return direction({p[0], p[1], p[2]}); }

NodeFacts know_mirror(Params p, std::span<const NodeFacts> children) {
  const NodeFacts& child = children[0];
  NodeFacts k = mapped(child);
  k.cancellation += std::min(2 * std::abs(p[3]), largest_coordinate(child.box));
  const glm::dvec3 n = normal_of(p);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(n[i]) != 1) continue;
    const double plane = p[3] * n[i];
    Box kept = child.box;
    (n[i] > 0 ? kept.lo : kept.hi)[i] = n[i] > 0 ? std::max(kept.lo[i], plane) : std::min(kept.hi[i], plane);
    const bool whole = kept.lo == child.box.lo && kept.hi == child.box.hi;
    k.box = kept;
    k.box.lo[i] = std::min(kept.lo[i], 2 * plane - kept.hi[i]);
    k.box.hi[i] = std::max(kept.hi[i], 2 * plane - kept.lo[i]);
    k.symmetric = child.symmetric;
    k.symmetric[static_cast<std::size_t>(i)] = p[3] == 0;
    k.inside = std::max(k.inside, Exactness::Bound);
    return whole ? k : only_bound(k);
  }
  // Unites the box with the box of its mirror image. Per-axis distances do not survive the reflection.
  const glm::dvec3 centre = (child.box.lo + child.box.hi) * 0.5, half = child.box.hi - centre;
  glm::dvec3 spread(0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) spread[i] += std::abs((i == j ? 1 : 0) - 2 * n[i] * n[j]) * half[j];
  }
  const glm::dvec3 moved = centre - 2 * (glm::dot(centre, n) - p[3]) * n;
  k.box = child.box.finite() ? unite(child.box, {moved - spread, moved + spread}) : Box::everything();
  k.reach_max = std::min(k.reach_max, k.reach);
  return only_bound(k);
}

std::vector<double> mirror_immediates(Params p) {
  const glm::dvec3 n = normal_of(p);
  return {n.x, n.y, n.z, p[3]};
}
Code mirror_code(Params p) { return {.points = {{{Opcode::Mirror, mirror_immediates(p)}}}}; }

// Twist. Parameter: turn (degrees per unit of y). Derived: the tube's radius, the Lipschitz constant. For points p
// and q of the tube, |T(p) - T(q)|^2 <= (a + k R b)^2 + b^2, where a and b are their distances across and along the
// axis, k is the turn in radians and R is the tube's radius. The bound is the largest stretch of [[1, kR], [0, 1]].

double tube_radius(const Box& box) { return radius_about_y(box) * (1 + kAside); }

std::vector<double> derive_twist(Params p, std::span<const NodeFacts> children) {
  const double radius = tube_radius(children[0].box);
  return {radius, children[0].lipschitz * largest_stretch(1, std::abs(p[0]) * kRadians * radius, 1)};
}

ErrorText check_twist_child(Params, std::span<const NodeFacts> children) {
  return check_bounded_about_y(children, "a twist");
}

// Facts of a child evaluated within a tube about the y axis, by a map that treats distances across and along the axis
// separately.
NodeFacts in_tube(const NodeFacts& child, double radius, double lipschitz, double reach) {
  NodeFacts k = only_bound(mapped(child));
  k.box = tube(radius, child.box.lo.y, child.box.hi.y);
  k.lipschitz = lipschitz;
  k.reach = k.reach_max = reach;
  return k;
}

NodeFacts know_twist(Params p, std::span<const NodeFacts> children) {
  const double rate = std::abs(p[0]) * kRadians, radius = p[1];
  const Box& box = children[0].box;
  NodeFacts k = in_tube(children[0], radius, p[2], children[0].reach);
  // The angle's rounding error is proportional to the angle. An endless column counts by its first thousand units.
  const double highest = std::min(1000.0, std::max(std::abs(box.lo.y), std::abs(box.hi.y)));
  k.cancellation = (k.cancellation + radius * (1 + 0.2 * rate * highest)) * children[0].lipschitz;
  return k;
}

std::vector<Instruction> meet_tube(double radius, double lipschitz) {
  std::vector<Instruction> after = {{Opcode::InfiniteCylinder, {radius}}};
  if (lipschitz != 1) after.push_back({Opcode::Scale, {lipschitz}});
  after.push_back({Opcode::Meet});
  return after;
}

Code twist_code(Params p) {
  return {.points = {{{Opcode::ClampTube, {p[1]}}, {Opcode::Twist, {-p[0] * kRadians}}}},
          .after = meet_tube(p[1], p[2])};
}

// Taper. Parameters: bottom and top scale, half height. Derived: the tube's radius, the Lipschitz constant. With q =
// x / s(y): dq = dx / s - q s' / s dy, and |q| <= R / s_least in the tube of radius R.

struct Scales {
  double least, most, slope;
};
Scales scales(Params p) { return {std::min(p[0], p[1]), std::max(p[0], p[1]), (p[1] - p[0]) / (2 * p[2])}; }

std::vector<double> derive_taper(Params p, std::span<const NodeFacts> children) {
  const Scales s = scales(p);
  const double radius = tube_radius(children[0].box) * s.most;
  const double shear = std::abs(s.slope) * radius / (s.least * s.least);
  return {radius, children[0].lipschitz * largest_stretch(1 / s.least, shear, 1)};
}

ErrorText check_taper_child(Params, std::span<const NodeFacts> children) {
  return check_bounded_about_y(children, "a taper");
}

NodeFacts know_taper(Params p, std::span<const NodeFacts> children) {
  const Scales s = scales(p);
  NodeFacts k = in_tube(children[0], p[3], p[4], children[0].reach * std::min(1.0, 1 / s.most));
  if (s.least < 1) k.cancellation += radius_about_y(children[0].box) * std::max(1.0, children[0].lipschitz);
  return k;
}

Code taper_code(Params p) {
  const Scales s = scales(p);
  return {.points = {{{Opcode::ClampTube, {p[3]}}, {Opcode::Taper, {(p[0] + p[1]) / 2, s.slope, s.least, s.most}}}},
          .after = meet_tube(p[3], p[4])};
}

// Bend. Parameter: turn (degrees per unit of x, towards +y). Derived: the arc's radius and side, the inner radius,
// the Lipschitz constant, the distances of the solid from the inner circle and from the seam (as the child measures
// them), z range, reach, the box. The map keeps radii and multiplies lengths across them by (1/k) / rho, where k is
// the turn in radians and rho is the radius.

struct Arc {
  double radius, side;          // of the bent x axis; +1: towards +y
  double innermost, outermost;  // radii of the solid
  double farthest;              // largest |x| of the child
};
Arc arc(double turn, const Box& box) {
  const double radius = 1 / (std::abs(turn) * kRadians);
  const bool up = turn > 0;
  return {radius, up ? 1.0 : -1.0, radius - (up ? box.hi.y : -box.lo.y), radius + (up ? -box.lo.y : box.hi.y),
          std::max(std::abs(box.lo.x), std::abs(box.hi.x))};
}

// Returns the box around the sector of a ring that the child's box becomes.
Box bent_box(const Arc& a, const Box& box) {
  const double from = box.lo.x / a.radius, to = box.hi.x / a.radius;
  std::vector<double> angles = {from, to};
  for (double quarter = -2; quarter <= 2; ++quarter) {
    const double angle = quarter * std::numbers::pi / 2;
    if (angle > from && angle < to) angles.push_back(angle);
  }
  Box bent;
  for (double angle : angles) {
    for (double rho : {a.innermost, a.outermost}) {
      const double x = rho * vm::real::sin(angle), y = (a.radius - rho * vm::real::cos(angle)) * a.side;
      bent = unite(bent, {{x, y, box.lo.z}, {x, y, box.hi.z}});
    }
  }
  return bent;
}

std::vector<double> derive_bend(Params p, std::span<const NodeFacts> children) {
  // An inner radius closer to the solid's inner edge gives a smaller constant but shorter steps near the centre.
  constexpr double kInner = 0.8;
  const NodeFacts& child = children[0];
  const Arc a = arc(p[0], child.box);
  const double inner = kInner * a.innermost, reach = child.reach > 0 ? child.reach : 0.25;
  const Box exact = bent_box(a, child.box);
  const Box box = exact.grown(kAside * std::max(exact.hi.x - exact.lo.x, exact.hi.y - exact.lo.y));
  // The box's own distance, and the distance to the parts left out, change by 1.
  const double lipschitz = std::max(1.0, child.lipschitz * std::max(1.0, a.radius / inner));
  return {a.radius,
          a.side,
          inner,
          lipschitz,
          reach * (a.innermost - inner),
          reach * (std::numbers::pi * a.radius - a.farthest),
          std::clamp(box.lo.z, -kNoLimit, kNoLimit),
          std::clamp(box.hi.z, -kNoLimit, kNoLimit),
          reach,
          box.lo.x,
          box.lo.y,
          box.hi.x,
          box.hi.y};
}

ErrorText check_bend(Params p) {
  if (p[0] != 0) return std::nullopt;
  return "`turn` is 0, which bends nothing; leave the bend out or give degrees per unit of x";
}

ErrorText check_bend_child(Params p, std::span<const NodeFacts> children) {
  const Box& box = children[0].box;
  for (int i = 0; i < 2; ++i) {
    if (!std::isfinite(box.lo[i]) || !std::isfinite(box.hi[i])) {
      return fmt::format("a bend needs a node that ends in x and y, and this has no end along {}", "xy"[i]);
    }
  }
  const Arc a = arc(p[0], box);
  if (a.farthest >= std::numbers::pi * a.radius) {
    return fmt::format(
        "the node reaches to x = {:.4g} and would bend round more than a full turn; `turn` must be less "
        "than {:.4g}",
        a.farthest, 180 / a.farthest);
  }
  if (a.innermost <= 1e-3 * a.radius) {
    return fmt::format("the node is thicker than the bend's radius of {:.4g} on the inner side; make `turn` smaller",
                       a.radius);
  }
  return std::nullopt;
}

NodeFacts know_bend(Params p, std::span<const NodeFacts> children) {
  const NodeFacts& child = children[0];
  NodeFacts k = only_bound(mapped(child));
  k.box.lo.x = p[10], k.box.lo.y = p[11], k.box.hi.x = p[12], k.box.hi.y = p[13];
  k.box.lo.z = p[7] <= -kNoLimit ? k.box.lo.z : p[7];
  k.box.hi.z = p[8] >= kNoLimit ? k.box.hi.z : p[8];
  k.symmetric = {child.symmetric[0], false, child.symmetric[2]};
  k.lipschitz = p[4];
  k.reach = k.reach_max = 1;  // the box's own distance is part of the result
  k.cancellation = (child.cancellation + 2 * p[1]) * child.lipschitz;
  return k;
}

Code bend_code(Params p) {
  const double radius = p[1], side = p[2], inner = p[3];
  Code code{.points = {{{Opcode::Bend, {radius, side, inner}}}}};
  code.after = {{Opcode::BendLimit, {radius, side, inner, p[5], p[6], p[7], p[8], p[9]}},
                {Opcode::Min},
                {Opcode::BoxBetween, {p[10], p[11], p[7], p[12], p[13], p[8]}},
                {Opcode::Max}};
  return code;
}

// Shear moves x and z by a multiple of y, so it is a Transform.

NodeId build_shear(NodeMaker& maker, Params p, std::span<const NodeId> children, const SourceLocation& origin) {
  std::vector<double> params = {1, -p[0], 0, 0, 0, 1, 0, 0, 0, -p[1], 1, 0};
  // The smallest factor by which a shear shrinks distances, so that the scaled distance stays a lower bound.
  params.push_back(1 / singular_values(Affine::from_params(params)).most);
  return maker.make(Kind::Transform, params, children, origin);
}

}  // namespace

std::vector<NodeSpec> domain_rows() {
  constexpr auto kAlteration = Category::Alteration;
  return {
      {.kind = Kind::Mirror,
       .name = "mirror",
       .category = kAlteration,
       .params = {{"normal", ParamType::Vec3, Rule::NotZero, kRequired,
                   "of the plane, towards the side that is kept"},
                  number("offset", "of the plane from the origin, along the normal", 0.0)},
       .doc = "one side of a plane, and its mirror image",
       .code = mirror_code,
       .derive_facts = know_mirror},
      {.kind = Kind::Shear,
       .name = "shear",
       .category = kAlteration,
       .params = {{"shift", ParamType::Vec2, Rule::Any, kRequired, "how far x and z move per unit of y"}},
       .doc = "a node whose higher parts are moved aside",
       .operand = Sort::Solid,
       .build = build_shear},
      {.kind = Kind::Twist,
       .name = "twist",
       .category = kAlteration,
       .params = {number("turn", "degrees per unit of y")},
       .doc = "a node turned about the y axis, more the higher",
       .operand = Sort::Solid,
       .code = twist_code,
       .derive_facts = know_twist,
       .derive = derive_twist,
       .check_children = check_twist_child},
      {.kind = Kind::Bend,
       .name = "bend",
       .category = kAlteration,
       .params = {number("turn", "degrees per unit of x, towards +y")},
       .doc = "a node bent along x into a circular arc",
       .operand = Sort::Solid,
       .check = check_bend,
       .code = bend_code,
       .derive_facts = know_bend,
       .derive = derive_bend,
       .check_children = check_bend_child},
      {.kind = Kind::Taper,
       .name = "taper",
       .category = kAlteration,
       .params = {length("bottom", "scale in x and z at y = -half_height"),
                  length("top", "scale in x and z at y = half_height"),
                  length("half_height", "where the scale stops changing")},
       .doc = "a node made thinner or thicker along y",
       .operand = Sort::Solid,
       .code = taper_code,
       .derive_facts = know_taper,
       .derive = derive_taper,
       .check_children = check_taper_child},
  };
}

}  // namespace fathom::compiler
