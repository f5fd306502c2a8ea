// Rows of the solids that are made of other nodes. Their distance is as exact as what they are made of says.
#include <algorithm>
#include <array>

#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

constexpr auto kPrimitive = Category::Primitive;

NodeId place(Graph& graph, NodeId child, const std::array<double, 13>& transform, const Origin& origin) {
  return graph.add(Kind::Transform, transform, std::array{child}, origin);
}

// A ball squashed: its distance times the smallest radius is never too much. The exact distance takes an iteration.
NodeId ellipsoid(Graph& graph, Params p, const Origin& origin) {
  const NodeId ball = graph.add(Kind::Sphere, std::array{1.0}, {}, origin);
  const double x = p[0], y = p[1], z = p[2];
  return place(graph, ball, {1 / x, 0, 0, 0, 0, 1 / y, 0, 0, 0, 0, 1 / z, 0, std::min({x, y, z})}, origin);
}

// A ring pulled apart along its z, then turned about x until that is y.
NodeId link(Graph& graph, Params p, const Origin& origin) {
  const NodeId ring = graph.add(Kind::Torus, p.first(2), {}, origin);
  const NodeId pulled = graph.add(Kind::Elongate, std::array{0.0, 0.0, p[2]}, std::array{ring}, origin);
  return place(graph, pulled, {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 1}, origin);
}

Complaint check_ellipsoid(Params p) {
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
  };
}

}  // namespace fathom::compiler
