// Rows of the solids that are composed of other nodes. Their distance is as exact as the distances of these nodes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compiler/shapes/node_table.h"
#include "compiler/shapes/rows.h"
#include "vm/number/real.h"

namespace fathom::compiler {
namespace {

NodeId place(Graph& graph, NodeId child, const std::array<double, 13>& transform, const SourceLocation& origin) {
  return graph.add(Kind::Transform, transform, std::array{child}, origin);
}

// A ball scaled along the axes. The ball's distance times the smallest radius never exceeds the ellipsoid's. The
// exact distance takes an iteration.
NodeId ellipsoid(Graph& graph, Params p, const SourceLocation& origin) {
  const NodeId ball = graph.add(Kind::Sphere, std::array{1.0}, {}, origin);
  const double x = p[0], y = p[1], z = p[2];
  return place(graph, ball, {1 / x, 0, 0, 0, 0, 1 / y, 0, 0, 0, 0, 1 / z, 0, std::min({x, y, z})}, origin);
}

// Turns the child about x until its z axis is y.
NodeId upright(Graph& graph, NodeId child, const SourceLocation& origin) {
  return place(graph, child, {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 1}, origin);
}

NodeId prism(Graph& graph, double sides, Params p, const SourceLocation& origin) {
  const NodeId polygon = graph.add(Kind::RegularPolygon, std::array{sides, p[0]}, {}, origin);
  const NodeId drawn = graph.add(Kind::Extrude, std::array{p[1]}, std::array{polygon}, origin);
  return upright(graph, drawn, origin);
}
NodeId hexagonal_prism(Graph& graph, Params p, const SourceLocation& origin) { return prism(graph, 6, p, origin); }
NodeId triangular_prism(Graph& graph, Params p, const SourceLocation& origin) { return prism(graph, 3, p, origin); }

// Turns an outline with the same parameters, which is symmetric about the y axis, about that axis.
template <Kind Outline>
NodeId revolved(Graph& graph, Params p, const SourceLocation& origin) {
  const NodeId outline = graph.add(Outline, p, {}, origin);
  return graph.add(Kind::Revolve, std::array{0.0, 1.0}, std::array{outline}, origin);
}
template <Kind Outline>
ErrorText check_outline(Params p) {
  const auto check = spec(Outline).check;
  return check ? check(p) : std::nullopt;
}

// Turns an arc about -y. A point of the sphere at an angle of a from -y lies at y = -radius cos a, so the arc reaches
// up to the angle whose y is the height.
NodeId cut_hollow_sphere(Graph& graph, Params p, const SourceLocation& origin) {
  const double degrees = vm::real::acos(-p[1] / p[0]) * 180 / std::numbers::pi;
  const NodeId arc = graph.add(Kind::Arc, std::array{p[0], degrees, p[2]}, {}, origin);
  const NodeId turned = place(graph, arc, {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 1}, origin);
  return graph.add(Kind::Revolve, std::array{0.0, 1.0}, std::array{turned}, origin);
}
ErrorText check_cut_hollow_sphere(Params p) {
  if (std::abs(p[1]) < p[0] && p[2] < p[0]) return std::nullopt;
  return fmt::format("`height` {} must lie between -radius and radius, and `thickness` {} be less than `radius` {}",
                     p[1], p[2], p[0]);
}

// Turns the wall, a rectangle beside the axis, about that axis.
NodeId tube_around(Graph& graph, Params p, const SourceLocation& origin) {
  const NodeId wall = graph.add(Kind::Rectangle, std::array{p[2], p[1]}, {}, origin);
  return graph.add(Kind::Revolve, std::array{p[0], 1.0}, std::array{wall}, origin);
}
ErrorText check_tube(Params p) {
  if (p[2] < p[0]) return std::nullopt;
  return fmt::format("`thickness` {} is not smaller than `radius` {}, which leaves no hole; use `cylinder`", p[2],
                     p[0]);
}

// The sides of a diamond with half diagonals a and b are a b / sqrt(a^2 + b^2) from its middle. Rounding takes its
// radius from that distance.
double inradius(Params p) { return p[0] * p[1] / std::sqrt(p[0] * p[0] + p[1] * p[1]); }
NodeId rhombus(Graph& graph, Params p, const SourceLocation& origin) {
  const double shrink = 1 - p[3] / inradius(p);
  const NodeId diamond = graph.add(Kind::RhombusOutline, std::array{p[0] * shrink, p[1] * shrink}, {}, origin);
  const NodeId drawn = graph.add(Kind::Extrude, std::array{p[2] - p[3]}, std::array{diamond}, origin);
  const NodeId solid = upright(graph, drawn, origin);
  return p[3] > 0 ? graph.add(Kind::Round, std::array{p[3]}, std::array{solid}, origin) : solid;
}
ErrorText check_rhombus(Params p) {
  const double most = std::min(inradius(p), p[2]);
  if (p[3] < most) return std::nullopt;
  return fmt::format("`rounding` {} must be less than {:.4g}, the distance of the nearest side from the middle", p[3],
                     most);
}

// A ring pulled apart along its z axis, then turned about x until its z axis is y.
NodeId link(Graph& graph, Params p, const SourceLocation& origin) {
  const NodeId ring = graph.add(Kind::Torus, p.first(2), {}, origin);
  const NodeId pulled = graph.add(Kind::Elongate, std::array{0.0, 0.0, p[2]}, std::array{ring}, origin);
  return upright(graph, pulled, origin);
}

ErrorText check_ellipsoid(Params p) {
  if (p[0] > 0 && p[1] > 0 && p[2] > 0) return std::nullopt;
  return "`radii` must all be above 0";
}

}  // namespace

std::vector<NodeSpec> composed_rows() {
  return {
      {.kind = Kind::Ellipsoid,
       .name = "ellipsoid",
       .category = kPrimitive,
       .params = {{"radii", ParamType::Vec3, Rule::NotZero, kRequired, "along the axes"}},
       .doc = "a ball with three radii; its distance is a lower bound",
       .check = check_ellipsoid,
       .expand = ellipsoid},
      {.kind = Kind::Link,
       .name = "link",
       .category = kPrimitive,
       .params = {length("major_radius", "of the centre line of the two half rings"),
                  length("minor_radius", "of the tube"), length("half_length", "of the straight part, along y")},
       .doc = "a link of a chain in the xy plane",
       .expand = link},
      {.kind = Kind::HexagonalPrism,
       .name = "hexagonal_prism",
       .category = kPrimitive,
       .params = {length("radius", "of the circle through the corners"), length("half_height", "along y")},
       .doc = "an upright prism with six sides",
       .expand = hexagonal_prism},
      {.kind = Kind::TriangularPrism,
       .name = "triangular_prism",
       .category = kPrimitive,
       .params = {length("radius", "of the circle through the corners"), length("half_height", "along y")},
       .doc = "an upright prism with three sides",
       .expand = triangular_prism},
      {.kind = Kind::SolidAngle,
       .name = "solid_angle",
       .category = kPrimitive,
       .params = {length("radius", "of the ball"), length("angle", "from the y axis to the side, degrees")},
       .doc = "the part of a ball within a cone that opens along y from its centre",
       .check = check_outline<Kind::Pie>,
       .expand = revolved<Kind::Pie>},
      {.kind = Kind::CutSphere,
       .name = "cut_sphere",
       .category = kPrimitive,
       .params = {length("radius", "of the ball"), number("height", "of the cut; what lies above is taken away")},
       .doc = "a ball without its top",
       .check = check_outline<Kind::CutDisk>,
       .expand = revolved<Kind::CutDisk>},
      {.kind = Kind::CutHollowSphere,
       .name = "cut_hollow_sphere",
       .category = kPrimitive,
       .params = {length("radius", "of the middle of the wall"),
                  number("height", "of the opening; what lies above is taken away"), thickness()},
       .doc = "a bowl with a round rim",
       .check = check_cut_hollow_sphere,
       .expand = cut_hollow_sphere},
      {.kind = Kind::DeathStar,
       .name = "death_star",
       .category = kPrimitive,
       .params = {length("radius", "of the ball"), length("cut_radius", "of the ball that is taken away"),
                  length("distance", "of that ball's centre, along y")},
       .doc = "a ball with a dent the shape of a ball",
       .check = check_outline<Kind::Moon>,
       .expand = revolved<Kind::Moon>},
      {.kind = Kind::Tube,
       .name = "tube",
       .category = kPrimitive,
       .params = {length("radius", "of the middle of the wall"), length("half_height", "along y"), thickness()},
       .doc = "a pipe: a cylinder with a hole along y, flat ends",
       .check = check_tube,
       .expand = tube_around,
       .between = Between{"half_height", 0.5}},
      {.kind = Kind::Vesica,
       .name = "vesica",
       .category = kPrimitive,
       .params = {length("half_height", "from the middle to a tip, along y"), length("half_width", "in the middle")},
       .doc = "a lens turned about its long axis",
       .check = check_outline<Kind::VesicaOutline>,
       .expand = revolved<Kind::VesicaOutline>},
      {.kind = Kind::Rhombus,
       .name = "rhombus",
       .category = kPrimitive,
       .params = {length("half_width", "from the middle to a corner, along x"),
                  length("half_length", "from the middle to a corner, along z"), length("half_height", "along y"),
                  length_or_zero("rounding", "radius of the edges", 0.0)},
       .doc = "an upright prism whose base is a rhombus",
       .check = check_rhombus,
       .expand = rhombus},
  };
}

}  // namespace fathom::compiler
