#include "compiler/shapes/node_table.h"

#include "compiler/shapes/primitives.h"
#include "vm/check.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;
constexpr auto kNumber = ParamType::Number;
constexpr auto kInteger = ParamType::Integer;
constexpr auto kVec3 = ParamType::Vec3;
constexpr auto kExact = Exactness::Exact;
constexpr auto kBound = Exactness::Bound;
constexpr auto kEstimate = Exactness::Estimate;
constexpr std::optional<double> kRequired = std::nullopt;

ParamSpec length(std::string_view name, std::string_view doc) {
  return {name, kNumber, Rule::Positive, kRequired, doc};
}
ParamSpec length_or_zero(std::string_view name, std::string_view doc) {
  return {name, kNumber, Rule::NotNegative, kRequired, doc};
}
ParamSpec point(std::string_view name) { return {name, kVec3, Rule::Any, kRequired, "a corner, scene units"}; }

NodeSpec primitive(Kind kind, std::string_view name, std::vector<ParamSpec> params, std::string_view doc,
                   std::optional<std::string> (*check)(std::span<const double>), Opcode opcode,
                   std::vector<double> (*immediates)(std::span<const double>), Box (*bound)(std::span<const double>),
                   Exactness outside = kExact, Exactness inside = kExact) {
  return {kind, name, Category::Primitive, std::move(params), doc, check, opcode, immediates, bound, outside, inside};
}

NodeSpec of_children(Kind kind, std::string_view name, Category category, std::vector<ParamSpec> params,
                     std::string_view doc) {
  // Exactness follows from the children (compiler/bounds.h); a primitive's columns stay empty.
  return {kind, name, category, std::move(params), doc, nullptr, std::nullopt, nullptr, nullptr, kBound, kBound};
}

std::vector<NodeSpec> make_table() {
  const ParamSpec k{"k", kNumber, Rule::NotNegative, kRequired,
                    "width of the blend; the surface moves by at most k/4"};
  const ParamSpec thickness = length("thickness", "to either side of the surface");
  return {
      primitive(Kind::Sphere, "sphere", {length("radius", "of the ball")}, "a ball", nullptr, Opcode::Sphere,
                same_immediates, sphere_bound),
      primitive(Kind::Box, "box", {{"half_size", kVec3, Rule::Positive, kRequired, "half extents"}}, "a box", nullptr,
                Opcode::Box, same_immediates, half_size_bound),
      primitive(Kind::RoundBox, "round_box",
                {{"half_size", kVec3, Rule::Positive, kRequired, "half extents, rounding included"},
                 length_or_zero("radius", "of the edges")},
                "a box with rounded edges", check_round_box, Opcode::RoundBox, round_box_immediates, half_size_bound),
      // A spindle torus (minor > major) keeps an exact outside.
      primitive(Kind::Torus, "torus",
                {length("major_radius", "of the ring's centre line"), length("minor_radius", "of the tube")},
                "a ring about the y axis", nullptr, Opcode::Torus, same_immediates, torus_bound, kExact, kBound),
      primitive(Kind::Plane, "plane",
                {{"normal", kVec3, Rule::NotZero, kRequired, "points out of the solid; any length"},
                 {"offset", kNumber, Rule::Any, 0.0, "distance from the origin along the normal"}},
                "a half space", nullptr, Opcode::Plane, plane_immediates, plane_bound),
      primitive(Kind::Cylinder, "cylinder", {length("radius", "about the y axis"), length("half_height", "along y")},
                "a capped cylinder", nullptr, Opcode::Cylinder, same_immediates, cylinder_bound),
      primitive(
          Kind::RoundedCylinder, "rounded_cylinder",
          {length("radius", "about the y axis, rounding included"),
           length("half_height", "along y, rounding included"), length_or_zero("rounding", "radius of the rims")},
          "a capped cylinder with rounded rims", check_rounded_cylinder, Opcode::RoundedCylinder,
          rounded_cylinder_immediates, cylinder_bound),
      primitive(Kind::Cone, "cone",
                {length_or_zero("bottom_radius", "at y = -half_height"),
                 length_or_zero("top_radius", "at y = half_height"), length("half_height", "along y")},
                "a capped cone", check_cone, Opcode::Cone, cone_immediates, cone_bound),
      primitive(Kind::RoundCone, "round_cone",
                {length("bottom_radius", "of the ball at the origin"),
                 length("top_radius", "of the ball at y = height"), length("height", "between the balls' centres")},
                "the hull of two balls", check_round_cone, Opcode::RoundCone, round_cone_immediates,
                round_cone_bound),
      primitive(Kind::Triangle, "triangle", {point("a"), point("b"), point("c"), thickness},
                "a flat triangle with a thickness", check_triangle, Opcode::Triangle, sheet_immediates, sheet_bound),
      primitive(Kind::Quad, "quad", {point("a"), point("b"), point("c"), point("d"), thickness},
                "a flat convex quadrilateral with a thickness", check_quad, Opcode::Quad, sheet_immediates,
                sheet_bound),
      primitive(Kind::Mandelbulb, "mandelbulb",
                {{"power", kInteger, Rule::Positive, 8.0, "of the iteration, 2 to 24"},
                 {"iterations", kInteger, Rule::Positive, 8.0, "at most, 1 to 256"},
                 {"bailout", kNumber, Rule::Positive, 4.0, "radius beyond which a point has escaped, 2 or more"},
                 {"detail", kNumber, Rule::NotNegative, 0.001,
                  "the surface lies where the estimate is this; finer features go"}},
                "a fractal about the y axis; its distance is an estimate", check_mandelbulb, Opcode::Mandelbulb,
                mandelbulb_immediates, mandelbulb_bound, kEstimate, kEstimate),

      of_children(Kind::Round, "round", Category::Alteration,
                  {length_or_zero("radius", "how far the surface moves out")}, "a node made larger, its edges round"),
      of_children(Kind::Onion, "onion", Category::Alteration, {thickness}, "a shell around a node's surface"),
      of_children(Kind::Transform, "transform", Category::Internal, {}, "scale, rotate, translate"),
      of_children(Kind::Union, "union", Category::Combinator, {}, "what is in any of the nodes"),
      of_children(Kind::Intersection, "intersection", Category::Combinator, {}, "what is in all of the nodes"),
      of_children(Kind::Subtraction, "subtraction", Category::Combinator, {}, "the first node without the others"),
      of_children(Kind::SmoothUnion, "smooth_union", Category::Combinator, {k}, "union, blended from the left"),
      of_children(Kind::SmoothIntersection, "smooth_intersection", Category::Combinator, {k},
                  "intersection, blended from the left"),
      of_children(Kind::SmoothSubtraction, "smooth_subtraction", Category::Combinator, {k},
                  "subtraction, blended from the left"),
      of_children(Kind::Paint, "paint", Category::Internal, {}, "belongs to a surface"),
  };
}

}  // namespace

const std::vector<NodeSpec>& node_table() {
  static const std::vector<NodeSpec> table = make_table();
  return table;
}

const NodeSpec& spec(Kind kind) {
  const NodeSpec& row = node_table()[static_cast<std::size_t>(kind)];
  CHECK(row.kind == kind, "the node table is in the order of Kind");
  return row;
}

const NodeSpec* find_node(std::string_view name) {
  for (const NodeSpec& row : node_table()) {
    if (row.name == name && row.category != Category::Internal) return &row;
  }
  return nullptr;
}

}  // namespace fathom::compiler
