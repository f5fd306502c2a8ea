// Rows of the solids with round or straight sides, each with the facts that it alone needs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/geometry/direction.h"
#include "compiler/shapes/rows.h"
#include "vm/number/real.h"

namespace fathom::compiler {
namespace {

using glm::dvec3;
using vm::Opcode;

NodeSpec sphere_row() {
  return {.kind = Kind::Sphere,
          .name = "sphere",
          .category = kPrimitive,
          .params = {length("radius", "of the ball")},
          .doc = "a ball",
          .code = code_of<Opcode::Sphere>,
          .bound = [](Params p) { return Box::centred(dvec3(p[0])); },
          .facts = kSymmetric};
}

Box half_size_bound(Params p) { return Box::centred({p[0], p[1], p[2]}); }

NodeSpec box_row() {
  return {.kind = Kind::Box,
          .name = "box",
          .category = kPrimitive,
          .params = {half_size("half extents")},
          .doc = "a box",
          .code = code_of<Opcode::Box>,
          .bound = half_size_bound,
          .facts = kSymmetric};
}

ErrorText check_round_box(Params p) {
  const double smallest = std::min({p[0], p[1], p[2]});
  if (p[3] <= smallest) return std::nullopt;
  return fmt::format("`radius` {} is larger than the smallest half size {}; the rounding is part of the half size",
                     p[3], smallest);
}
Code round_box_code(Params p) { return one(Opcode::RoundBox, {p[0] - p[3], p[1] - p[3], p[2] - p[3], p[3]}); }
NodeSpec round_box_row() {
  return {.kind = Kind::RoundBox,
          .name = "round_box",
          .category = kPrimitive,
          .params = {half_size("half extents, rounding included"), length_or_zero("radius", "of the edges")},
          .doc = "a box with rounded edges",
          .check = check_round_box,
          .code = round_box_code,
          .bound = half_size_bound,
          .facts = kSymmetric};
}

ErrorText check_box_frame(Params p) {
  const double smallest = std::min({p[0], p[1], p[2]});
  if (2 * p[3] <= smallest) return std::nullopt;
  return fmt::format(
      "`thickness` {} is more than {}, half the smallest half size: the bars, 2 * `thickness` wide, "
      "would overlap; use a box",
      p[3], smallest / 2);
}
Code box_frame_code(Params p) {
  return one(Opcode::BoxFrame, {p[0], p[1], p[2], p[0] - 2 * p[3], p[1] - 2 * p[3], p[2] - 2 * p[3]});
}
NodeSpec box_frame_row() {
  return {.kind = Kind::BoxFrame,
          .name = "box_frame",
          .category = kPrimitive,
          .params = {half_size("half extents, bars included"),
                     length("thickness", "half the width of the bars, within the half size")},
          .doc = "the edges of a box as bars",
          .check = check_box_frame,
          .code = box_frame_code,
          .bound = half_size_bound,
          .facts = kSymmetric};
}

// Near the inner side of a fat ring, the centre line is much further away than the origin.
double torus_magnitude(Params p) { return std::min(p[0], p[1]); }

Box torus_bound(Params p) { return Box::centred({p[0] + p[1], p[1], p[0] + p[1]}); }
// A spindle torus (minor > major) keeps an exact outside.
NodeSpec torus_row() {
  return {.kind = Kind::Torus,
          .name = "torus",
          .category = kPrimitive,
          .params = {length("major_radius", "of the ring's centre line"), length("minor_radius", "of the tube")},
          .doc = "a ring about the y axis",
          .code = code_of<Opcode::Torus>,
          .bound = torus_bound,
          .facts = {Exactness::Exact, Exactness::Bound, kAllAxes},
          .cancellation = torus_magnitude};
}

ErrorText check_capped_torus(Params p) {
  if (p[2] <= 180) return std::nullopt;
  return fmt::format("`angle` is {}; it is half of what remains of the ring, at most 180 degrees", p[2]);
}
Code capped_torus_code(Params p) {
  const auto [sine, cosine] = vm::real::sin_cos_degrees(p[2]);
  return one(Opcode::CappedTorus, {p[0], p[1], sine, cosine});
}
Box capped_torus_bound(Params p) {
  const auto [sine, cosine] = vm::real::sin_cos_degrees(p[2]);
  const double side = p[2] < 90 ? p[0] * sine + p[1] : p[0] + p[1];
  return {{-side, p[0] * cosine - p[1], -p[1]}, {side, p[0] + p[1], p[1]}};
}
// The inside is only a bound where the ends of an arc meet, or its hole closes.
NodeSpec capped_torus_row() {
  return {.kind = Kind::CappedTorus,
          .name = "capped_torus",
          .category = kPrimitive,
          .params = {length("major_radius", "of the ring's centre line"), length("minor_radius", "of the tube"),
                     length("angle", "of the arc that remains, from its middle to an end, degrees, at most 180")},
          .doc = "a part of a ring in the xy plane, its middle on +y, with round ends",
          .check = check_capped_torus,
          .code = capped_torus_code,
          .bound = capped_torus_bound,
          .facts = {Exactness::Exact, Exactness::Bound, kXAndZ},
          .cancellation = torus_magnitude};
}

Code plane_code(Params p) {
  const dvec3 n = direction({p[0], p[1], p[2]});
  return one(Opcode::Plane, {n.x, n.y, n.z, p[3]});
}
// A half space is bounded on one side if its normal is along an axis.
Box plane_bound(Params p) {
  Box box = Box::everything();
  const dvec3 n = direction({p[0], p[1], p[2]});
  for (int axis = 0; axis < 3; ++axis) {
    if (n[axis] == 1) box.hi[axis] = p[3];
    if (n[axis] == -1) box.lo[axis] = -p[3];
  }
  return box;
}
NodeSpec plane_row() {
  return {.kind = Kind::Plane,
          .name = "plane",
          .category = kPrimitive,
          .params = {{"normal", ParamType::Vec3, Rule::NotZero, kRequired, "points out of the solid; any length"},
                     number("offset", "distance from the origin along the normal", 0.0)},
          .doc = "a half space",
          .code = plane_code,
          .bound = plane_bound};
}

Box cylinder_bound(Params p) { return Box::centred({p[0], p[1], p[0]}); }

NodeSpec cylinder_row() {
  return {.kind = Kind::Cylinder,
          .name = "cylinder",
          .category = kPrimitive,
          .params = {length("radius", "about the y axis"), length("half_height", "along y")},
          .doc = "a capped cylinder",
          .code = code_of<Opcode::Cylinder>,
          .bound = cylinder_bound,
          .facts = kSymmetric,
          .between = Between{"half_height", 0.5}};
}

ErrorText check_rounded_cylinder(Params p) {
  const double smallest = std::min(p[0], p[1]);
  if (p[2] <= smallest) return std::nullopt;
  return fmt::format("`rounding` {} is larger than {}, the smaller of `radius` and `half_height`; it is part of both",
                     p[2], smallest);
}
Code rounded_cylinder_code(Params p) { return one(Opcode::RoundedCylinder, {p[0] - p[2], p[1] - p[2], p[2]}); }
NodeSpec rounded_cylinder_row() {
  return {.kind = Kind::RoundedCylinder,
          .name = "rounded_cylinder",
          .category = kPrimitive,
          .params = {length("radius", "about the y axis, rounding included"),
                     length("half_height", "along y, rounding included"),
                     length_or_zero("rounding", "radius of the rims")},
          .doc = "a capped cylinder with rounded rims",
          .check = check_rounded_cylinder,
          .code = rounded_cylinder_code,
          .bound = cylinder_bound,
          .facts = kSymmetric,
          .between = Between{"half_height", 0.5}};
}

Box infinite_cylinder_bound(Params p) { return Box::centred({p[0], kInfinity, p[0]}); }
NodeSpec infinite_cylinder_row() {
  return {.kind = Kind::InfiniteCylinder,
          .name = "infinite_cylinder",
          .category = kPrimitive,
          .params = {length("radius", "about the y axis")},
          .doc = "a cylinder without ends",
          .code = code_of<Opcode::InfiniteCylinder>,
          .bound = infinite_cylinder_bound,
          .facts = kSymmetric};
}

Box capsule_bound(Params p) { return Box::centred({p[0], p[0] + p[1], p[0]}); }
NodeSpec capsule_row() {
  return {
      .kind = Kind::Capsule,
      .name = "capsule",
      .category = kPrimitive,
      .params = {length("radius", "of the two balls"), length("half_height", "along y, to the centres of the balls")},
      .doc = "a cylinder with balls for ends: all within the radius of a segment",
      .code = code_of<Opcode::Capsule>,
      .bound = capsule_bound,
      .facts = kSymmetric,
      .between = Between{"half_height", 0.5}};
}

ErrorText check_cone(Params p) {
  if (p[0] > 0 || p[1] > 0) return std::nullopt;
  return "both radii are 0; one of `bottom_radius` and `top_radius` must be positive";
}
Box cone_bound(Params p) {
  const double radius = std::max(p[0], p[1]);
  return Box::centred({radius, p[2], radius});
}
NodeSpec cone_row() {
  return {.kind = Kind::Cone,
          .name = "cone",
          .category = kPrimitive,
          .params = {length_or_zero("bottom_radius", "at y = -half_height"),
                     length_or_zero("top_radius", "at y = half_height"), length("half_height", "along y")},
          .doc = "a capped cone",
          .check = check_cone,
          .code = [](Params p) { return one(Opcode::Cone, slanted_profile(p[0], p[1], p[2])); },
          .bound = cone_bound,
          .facts = kUpright,
          .between = Between{"half_height", 0.5}};
}

ErrorText check_round_cone(Params p) {
  if (std::abs(p[0] - p[1]) <= p[2]) return std::nullopt;
  return fmt::format("the radii differ by {}, more than `height` {}: one ball holds the other; use a sphere",
                     std::abs(p[0] - p[1]), p[2]);
}
Box round_cone_bound(Params p) {
  const double radius = std::max(p[0], p[1]);
  return {{-radius, std::min(-p[0], p[2] - p[1]), -radius}, {radius, std::max(p[0], p[2] + p[1]), radius}};
}
NodeSpec round_cone_row() {
  return {
      .kind = Kind::RoundCone,
      .name = "round_cone",
      .category = kPrimitive,
      .params = {length("bottom_radius", "of the ball at the origin"),
                 length("top_radius", "of the ball at y = height"), length("height", "between the balls' centres")},
      .doc = "the hull of two balls",
      .check = check_round_cone,
      .code = code_of<Opcode::RoundCone, round_profile>,
      .bound = round_cone_bound,
      .facts = kUpright,
      .between = Between{"height", 1}};
}

ErrorText check_infinite_cone(Params p) {
  if (p[0] < 90) return std::nullopt;
  return fmt::format("`angle` is {}; it is measured from the axis to the side and must be below 90 degrees", p[0]);
}
Code infinite_cone_code(Params p) {
  const auto [sine, cosine] = vm::real::sin_cos_degrees(p[0]);
  return one(Opcode::InfiniteCone, {sine, cosine});
}
Box infinite_cone_bound(Params) {
  Box box = Box::everything();
  box.hi.y = 0;
  return box;
}
NodeSpec infinite_cone_row() {
  return {.kind = Kind::InfiniteCone,
          .name = "infinite_cone",
          .category = kPrimitive,
          .params = {length("angle", "between the axis and the side, degrees, below 90")},
          .doc = "a cone without a base, its tip at the origin, opening towards -y",
          .check = check_infinite_cone,
          .code = infinite_cone_code,
          .bound = infinite_cone_bound,
          .facts = kUpright};
}

}  // namespace

std::vector<NodeSpec> solid_rows() {
  return {sphere_row(),       box_row(),   round_box_row(),  box_frame_row(),        torus_row(),
          capped_torus_row(), plane_row(), cylinder_row(),   rounded_cylinder_row(), infinite_cylinder_row(),
          capsule_row(),      cone_row(),  round_cone_row(), infinite_cone_row()};
}

}  // namespace fathom::compiler
