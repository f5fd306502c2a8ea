// Rows of the outlines with arcs, and of the crosses: shapes in the xy plane, for extrude and revolve. All distances
// are exact outside, and also inside except for `arc`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/shapes/planar.h"
#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

using glm::dvec2;
using vm::Opcode;

ErrorText check_uneven_capsule(Params p) {
  if (std::abs(p[0] - p[1]) <= p[2]) return std::nullopt;
  return fmt::format("the radii differ by {}, more than `height` {}: one disk holds the other; use `circle`",
                     std::abs(p[0] - p[1]), p[2]);
}
Box uneven_capsule_bound(Params p) {
  const double radius = std::max(p[0], p[1]);
  return planar_box({-radius, std::min(-p[0], p[2] - p[1])}, {radius, std::max(p[0], p[2] + p[1])});
}
NodeSpec uneven_capsule_row() {
  return {
      .kind = Kind::UnevenCapsule,
      .name = "uneven_capsule",
      .category = kPrimitive,
      .params = {length("bottom_radius", "of the disk at the origin"),
                 length("top_radius", "of the disk at y = height"), length("height", "between the disks' centres")},
      .doc = "the hull of two disks",
      .sort = Sort::Outline,
      .check = check_uneven_capsule,
      .code = code_of<Opcode::UnevenCapsule, round_profile>,
      .bound = uneven_capsule_bound,
      .facts = kUpright};
}

ParamSpec angle(std::string_view doc, std::optional<double> fallback = kRequired) {
  return {"angle", ParamType::Number, Rule::Positive, fallback, doc};
}
ErrorText check_angle(double angle, bool closed, const char* other) {
  if (angle > 0 && (angle < 180 || (closed && angle == 180))) return std::nullopt;
  return fmt::format("`angle` is {}; it must be above 0 and {} 180{}", angle, closed ? "at most" : "below", other);
}
ErrorText check_thickness(double thickness, double radius, const char* other) {
  if (thickness < radius) return std::nullopt;
  return fmt::format("`thickness` {} is not smaller than `radius` {}, which leaves no hole; use `{}`", thickness,
                     radius, other);
}

// Returns the box of the part of a circle about the origin that is at most `angle` from +y.
Box arc_box(double radius, double angle) {
  const dvec2 end = at_polar(radius, angle);
  return mirrored_hull({{0, radius}, {angle >= 90 ? radius : end.x, radius}, end});
}

ErrorText check_arc(Params p) {
  if (ErrorText complaint = check_angle(p[1], true, ", a full circle")) return complaint;
  return check_thickness(p[2], p[0], p[1] == 180 ? "circle" : "pie");
}
Code arc_code(Params p) {
  const vm::real::SinCos at = vm::real::sin_cos_degrees(p[1]);
  return one(Opcode::Arc, {p[0], p[2], at.sin, at.cos, p[0] * at.sin, p[0] * at.cos});
}
Box arc_bound(Params p) { return arc_box(p[0], p[1]).grown(p[2]); }

// Round ends that overlap are deeper than the distance from the middle line says.
NodeSpec arc_row() {
  return {.kind = Kind::Arc,
          .name = "arc",
          .category = kPrimitive,
          .params = {length("radius", "of the arc's middle line"), angle("from +y to either end, at most 180"),
                     length("thickness", "to either side")},
          .doc = "a part of a circle about +y with a thickness and round ends",
          .sort = Sort::Outline,
          .check = check_arc,
          .code = arc_code,
          .bound = arc_bound,
          .facts = {Exactness::Exact, Exactness::Bound, kXAndZ},
          .cancellation = outline_magnitude<arc_bound>};
}

// A whole ring has no ends.
Code ring_code(Params p) {
  if (p[1] == 180) return arc_code(p);
  const vm::real::SinCos at = vm::real::sin_cos_degrees(p[1]);
  return one(Opcode::Ring, {p[0], p[2], at.sin, at.cos, p[0] - p[2], p[0] + p[2]});
}
Box ring_bound(Params p) { return unite(arc_box(p[0] + p[2], p[1]), mirrored_hull({at_polar(p[0] - p[2], p[1])})); }

NodeSpec ring_row() {
  return {
      .kind = Kind::Ring,
      .name = "ring",
      .category = kPrimitive,
      .params = {length("radius", "of the ring's middle line"),
                 angle("from +y to either end; 180 is the whole ring", 180.0), length("thickness", "to either side")},
      .doc = "a ring, or a part of one about +y with flat ends",
      .sort = Sort::Outline,
      .check = check_arc,
      .code = ring_code,
      .bound = ring_bound,
      .facts = kUpright,
      .cancellation = outline_magnitude<ring_bound>};
}

// A whole disk has no sides.
Code pie_code(Params p) {
  if (p[1] == 180) return one(Opcode::Circle, {p[0]});
  const vm::real::SinCos at = vm::real::sin_cos_degrees(p[1]);
  return one(Opcode::Pie, {p[0], at.sin, at.cos});
}
NodeSpec pie_row() {
  return {.kind = Kind::Pie,
          .name = "pie",
          .category = kPrimitive,
          .params = {length("radius", "of the disk"), angle("from +y to either side, at most 180")},
          .doc = "a sector of a disk about +y",
          .sort = Sort::Outline,
          .check = [](Params p) { return check_angle(p[1], true, ", a full disk"); },
          .code = pie_code,
          .bound = [](Params p) { return unite(arc_box(p[0], p[1]), mirrored_hull({dvec2(0)})); },
          .facts = kUpright};
}

double half_chord(Params p) { return std::sqrt((p[0] - p[1]) * (p[0] + p[1])); }
ErrorText check_cut_disk(Params p) {
  if (std::abs(p[1]) < p[0]) return std::nullopt;
  return fmt::format("`height` {} is not within the disk of `radius` {}: {}", p[1], p[0],
                     p[1] > 0 ? "nothing is cut off; use `circle`" : "nothing is left");
}
Code cut_disk_code(Params p) { return one(Opcode::CutDisk, {p[0], p[1], half_chord(p)}); }
Box cut_disk_bound(Params p) { return mirrored_hull({{0, -p[0]}, {p[1] >= 0 ? p[0] : half_chord(p), p[1]}}); }
NodeSpec cut_disk_row() {
  return {
      .kind = Kind::CutDisk,
      .name = "cut_disk",
      .category = kPrimitive,
      .params = {length("radius", "of the disk"), number("height", "what lies above is cut off; within the disk")},
      .doc = "a disk cut off straight",
      .sort = Sort::Outline,
      .check = check_cut_disk,
      .code = cut_disk_code,
      .bound = cut_disk_bound,
      .facts = kUpright};
}

ErrorText check_horseshoe(Params p) {
  if (ErrorText complaint = check_angle(p[1], false, "")) return complaint;
  if (ErrorText complaint = check_thickness(p[3], p[0], "pie")) return complaint;
  const vm::real::SinCos at = vm::real::sin_cos_degrees(p[1]);
  const double inner = p[0] - p[3], clear = inner * at.sin + std::min(0.0, p[2] * at.cos);
  if (clear >= 0) return std::nullopt;
  return fmt::format("the legs cross each other: give a `length` of at most {:.6g}, or a smaller `angle`",
                     inner * at.sin / -at.cos);
}
Code horseshoe_code(Params p) {
  const vm::real::SinCos at = vm::real::sin_cos_degrees(p[1]);
  return one(Opcode::Horseshoe, {p[0], p[3], at.sin, at.cos, p[2], p[0] - p[3], p[0] + p[3]});
}
Box horseshoe_bound(Params p) {
  const vm::real::SinCos at = vm::real::sin_cos_degrees(p[1]);
  const dvec2 leg = p[2] * dvec2(at.cos, -at.sin);
  const dvec2 outer = at_polar(p[0] + p[3], p[1]), inner = at_polar(p[0] - p[3], p[1]);
  return unite(arc_box(p[0] + p[3], p[1]), mirrored_hull({inner, outer + leg, inner + leg}));
}
NodeSpec horseshoe_row() {
  return {
      .kind = Kind::Horseshoe,
      .name = "horseshoe",
      .category = kPrimitive,
      .params = {length("radius", "of the bow's middle line"), angle("of the bow, from +y to either end, below 180"),
                 length_or_zero("length", "of the legs"), length("thickness", "to either side")},
      .doc = "a bow about +y whose ends go on straight, flat ends",
      .sort = Sort::Outline,
      .check = check_horseshoe,
      .code = horseshoe_code,
      .bound = horseshoe_bound,
      .facts = kUpright,
      .cancellation = outline_magnitude<horseshoe_bound>};
}

ErrorText check_lens(Params p) {
  if (p[1] < p[0]) return std::nullopt;
  return fmt::format(
      "`half_width` {} is not smaller than `half_height` {}; exchange them and turn it with rotate, or make it round",
      p[1], p[0]);
}
Code lens_code(Params p) {
  const double h = p[0], w = p[1], radius = (h * h + w * w) / (2 * w), centre = (h - w) * (h + w) / (2 * w);
  return one(Opcode::Lens, {h, centre, radius, centre / radius, h / radius});
}
Box lens_bound(Params p) { return planar_box({-p[1], -p[0]}, {p[1], p[0]}); }
NodeSpec lens_row() {
  return {.kind = Kind::VesicaOutline,
          .name = "lens",
          .category = kPrimitive,
          .params = {length("half_height", "of the tips, which are on the y axis"),
                     length("half_width", "along x, smaller than half_height")},
          .doc = "what two equal disks share",
          .sort = Sort::Outline,
          .check = check_lens,
          .code = lens_code,
          .bound = lens_bound,
          .facts = kSymmetric};
}

ErrorText check_moon(Params p) {
  const double radius = p[0], cut = p[1], distance = p[2];
  const char* others = "`radius`, `cut_radius` and `distance` do not fit together: ";
  if (distance >= radius + cut) return fmt::format("{}the cut is outside the disk; use `circle`", others);
  if (cut >= radius + distance) return fmt::format("{}the cut holds the whole disk; nothing is left", others);
  if (radius >= cut + distance) {
    return fmt::format("{}the cut is a hole within the disk; use `subtraction` of two circles", others);
  }
  return std::nullopt;
}
// Returns the point, x > 0, where the circles of a moon meet.
dvec2 moon_corner(double radius, double cut, double distance) {
  const double y = ((radius - cut) * (radius + cut) + distance * distance) / (2 * distance);
  return {std::sqrt((radius - y) * (radius + y)), y};
}
Code moon_code(Params p) {
  const dvec2 corner = moon_corner(p[0], p[1], p[2]);
  const dvec2 of_disk = corner / p[0], of_cut = (dvec2(0, p[2]) - corner) / p[1];
  return one(Opcode::Moon, {p[0], p[1], p[2], corner.x, corner.y, of_disk.x, of_disk.y, of_cut.x, of_cut.y});
}
// The part of the disk that remains lies below the corners.
Box moon_bound(Params p) {
  const dvec2 corner = moon_corner(p[0], p[1], p[2]);
  return mirrored_hull({{0, -p[0]}, {corner.y >= 0 ? p[0] : corner.x, corner.y}});
}
// The cut's circle is evaluated from its own centre.
double moon_magnitude(Params p) { return p[2]; }

NodeSpec moon_row() {
  return {.kind = Kind::Moon,
          .name = "moon",
          .category = kPrimitive,
          .params = {length("radius", "of the disk, at the origin"), length("cut_radius", "of the disk cut out"),
                     length("distance", "of the cut's centre, along +y")},
          .doc = "a disk without another",
          .sort = Sort::Outline,
          .check = check_moon,
          .code = moon_code,
          .bound = moon_bound,
          .facts = kUpright,
          .cancellation = moon_magnitude};
}

ErrorText check_egg(Params p) {
  if (!(p[1] < p[0])) {
    return fmt::format("`top_radius` {} is not smaller than `bottom_radius` {}; use `uneven_capsule`", p[1], p[0]);
  }
  if (p[2] > p[0] - p[1]) return std::nullopt;
  return fmt::format(
      "`height` {} is not larger than {}, by how much the radii differ: the bottom holds the top; use "
      "`circle`",
      p[2], p[0] - p[1]);
}
// An egg's side is an arc about (-centre, 0) that touches the bottom from outside, and centre^2 + height^2 = (centre
// + bottom - top)^2.
Code egg_code(Params p) {
  const double less = p[0] - p[1], centre = (p[2] - less) * (p[2] + less) / (2 * less);
  const double radius = centre + p[0], to_top = radius - p[1];
  return one(Opcode::Egg, {p[0], p[1], p[2], centre, radius, centre / to_top, p[2] / to_top});
}
Box egg_bound(Params p) { return planar_box({-p[0], -p[0]}, {p[0], p[2] + p[1]}); }
NodeSpec egg_row() {
  return {.kind = Kind::Egg,
          .name = "egg",
          .category = kPrimitive,
          .params = {length("bottom_radius", "of the half disk at the origin"),
                     length("top_radius", "of the round at y = height, smaller"),
                     length("height", "of the top's centre above the origin")},
          .doc = "an egg: round below and above, sides that touch both, widest at y = 0",
          .sort = Sort::Outline,
          .check = check_egg,
          .code = egg_code,
          .bound = egg_bound,
          .facts = kUpright};
}

Box heart_bound(Params p) {
  const double radius = p[0] * std::numbers::sqrt2 / 4;
  return mirrored_hull({{0, 0}, {0.25 * p[0] + radius, 0.75 * p[0] + radius}});
}
NodeSpec heart_row() {
  return {.kind = Kind::Heart,
          .name = "heart",
          .category = kPrimitive,
          .params = {length("size", "from the tip, which is the origin, up to the notch")},
          .doc = "a heart: two half disks on a square",
          .sort = Sort::Outline,
          .code = code_of<Opcode::Heart>,
          .bound = heart_bound,
          .facts = kUpright};
}

ErrorText check_cross(Params p) {
  if (p[1] < p[0]) return std::nullopt;
  return fmt::format("`half_width` {} is not smaller than `half_length` {}; use `rectangle`", p[1], p[0]);
}
std::vector<dvec2> cross_corners(Params p) {
  const double l = p[0], w = p[1];
  return {{w, l}, {w, w}, {l, w}, {l, -w}, {w, -w}, {w, -l}, {-w, -l}, {-w, -w}, {-l, -w}, {-l, w}, {-w, w}, {-w, l}};
}
NodeSpec cross_row() {
  return {
      .kind = Kind::Cross,
      .name = "cross",
      .category = kPrimitive,
      .params = {length("half_length", "of the arms"), length("half_width", "of the arms, smaller than half_length")},
      .doc = "a cross with four equal arms",
      .sort = Sort::Outline,
      .check = check_cross,
      .code = code_of<Opcode::Cross>,
      .bound = square_bound,
      .facts = kSymmetric,
      .corners = cross_corners};
}

// The inner corners between the arms exist while the arms' ends lie beyond them: radius <= sqrt 2 (half size -
// radius).
ErrorText check_rounded_x(Params p) {
  const double most = p[0] * std::numbers::sqrt2 / (1 + std::numbers::sqrt2);
  if (p[1] <= most) return std::nullopt;
  return fmt::format(
      "`radius` {} is larger than {:.6g}, for which the arms of `half_size` {} fill what is between them", p[1], most,
      p[0]);
}
Code rounded_x_code(Params p) { return one(Opcode::RoundedX, {p[1], std::numbers::sqrt2 * (p[0] - p[1])}); }
NodeSpec rounded_x_row() {
  return {.kind = Kind::RoundedX,
          .name = "rounded_x",
          .category = kPrimitive,
          .params = {length("half_size", "along x and y, rounding included"),
                     length("radius", "of the arms, half their width")},
          .doc = "a cross along the diagonals with round ends",
          .sort = Sort::Outline,
          .check = check_rounded_x,
          .code = rounded_x_code,
          .bound = square_bound,
          .facts = kSymmetric};
}

Code ellipse_code(Params p) {
  const double major = std::max(p[0], p[1]), minor = std::min(p[0], p[1]);
  return one(Opcode::Ellipse, {major, minor, (major - minor) * (major + minor), p[1] > p[0] ? 1.0 : 0.0});
}
NodeSpec ellipse_row() {
  return {.kind = Kind::Ellipse,
          .name = "ellipse",
          .category = kPrimitive,
          .params = {{"radii", ParamType::Vec2, Rule::Positive, kRequired, "along x and y"}},
          .doc = "an ellipse",
          .sort = Sort::Outline,
          .code = ellipse_code,
          .bound = half_sizes_bound,
          .facts = kSymmetric};
}

}  // namespace

std::vector<NodeSpec> round_outline_rows() {
  return {uneven_capsule_row(), arc_row(), ring_row(),  pie_row(),   cut_disk_row(),  horseshoe_row(), lens_row(),
          moon_row(),           egg_row(), heart_row(), cross_row(), rounded_x_row(), ellipse_row()};
}

}  // namespace fathom::compiler
