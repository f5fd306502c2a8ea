// Rows of the plain outlines, most of which have straight edges: shapes in the xy plane, for extrude and revolve. All
// distances are exact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/shapes/planar.h"
#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

using glm::dvec2;
using vm::Opcode;

constexpr PrimitiveFacts kAlongZ{.symmetric = {false, false, true}};

using Corners = std::vector<dvec2>;

ParamSpec half_size_2d(std::string_view doc) {
  return {"half_size", ParamType::Vec2, Rule::Positive, kRequired, doc};
}

Box hull(Params points) {
  Box box;
  for (std::size_t i = 0; i + 1 < points.size(); i += 2)
    box = unite(box, planar_box(vec2_at(points, i), vec2_at(points, i)));
  return box;
}

ErrorText check_sides(double sides, const char* name) {
  if (sides >= 3 && sides <= 64) return std::nullopt;
  return fmt::format("`{}` is {}; it must be a whole number from 3 to 64", name, sides);
}

// Returns mirror lines that fold half the plane onto a sector of 180 / n degrees from +y. Each line halves the number
// of sectors.
std::vector<double> sector_folds(int n) {
  std::vector<double> normals;
  int sectors = n;
  while (normals.size() < 12) {
    if (sectors == 1) {
      normals.insert(normals.end(), {0, 0});
      continue;
    }
    sectors = (sectors + 1) / 2;
    const vm::real::SinCos line = vm::real::sin_cos_degrees(180.0 * sectors / n);
    normals.insert(normals.end(), {-line.cos, line.sin});
  }
  return normals;
}

NodeSpec circle_row() {
  return {.kind = Kind::Circle,
          .name = "circle",
          .category = kPrimitive,
          .params = {length("radius", "of the disk")},
          .doc = "a disk",
          .sort = Sort::Outline,
          .code = code_of<Opcode::Circle>,
          .bound = square_bound,
          .facts = kSymmetric};
}

Corners rectangle_corners(Params p) { return {{p[0], p[1]}, {-p[0], p[1]}, {-p[0], -p[1]}, {p[0], -p[1]}}; }

NodeSpec rectangle_row() {
  return {.kind = Kind::Rectangle,
          .name = "rectangle",
          .category = kPrimitive,
          .params = {half_size_2d("half extents")},
          .doc = "a rectangle",
          .sort = Sort::Outline,
          .code = code_of<Opcode::Rectangle>,
          .bound = half_sizes_bound,
          .facts = kSymmetric,
          .corners = rectangle_corners};
}

ErrorText check_rounded_rectangle(Params p) {
  const double smallest = std::min(p[0], p[1]);
  if (p[2] <= smallest) return std::nullopt;
  return fmt::format("`radius` {} is larger than the smallest half size {}; the rounding is part of the half size",
                     p[2], smallest);
}
Code rounded_rectangle_code(Params p) { return one(Opcode::RoundedRectangle, {p[0] - p[2], p[1] - p[2], p[2]}); }
NodeSpec rounded_rectangle_row() {
  return {.kind = Kind::RoundedRectangle,
          .name = "rounded_rectangle",
          .category = kPrimitive,
          .params = {half_size_2d("half extents, rounding included"), length_or_zero("radius", "of the corners")},
          .doc = "a rectangle with rounded corners",
          .sort = Sort::Outline,
          .check = check_rounded_rectangle,
          .code = rounded_rectangle_code,
          .bound = half_sizes_bound,
          .facts = kSymmetric};
}

ParamSpec end_point(std::string_view name, std::string_view doc) {
  return {name, ParamType::Vec2, Rule::Any, kRequired, doc};
}
ErrorText check_segment(Params p) {
  if (vec2_at(p, 0) != vec2_at(p, 2)) return std::nullopt;
  return "ends `a` and `b` coincide; use `circle`";
}
Code segment_code(Params p) {
  const dvec2 way = vec2_at(p, 2) - vec2_at(p, 0);
  const double length = glm::length(way);
  return one(Opcode::Segment, {p[0], p[1], way.x / length, way.y / length, length, p[4]});
}
// The segment is evaluated from its first end, whose distance from zero counts, or the segment's size if smaller.
double segment_magnitude(Params p) {
  return std::min(std::max(std::abs(p[0]), std::abs(p[1])), glm::length(vec2_at(p, 2) - vec2_at(p, 0)) + p[4]);
}
NodeSpec segment_row() {
  return {.kind = Kind::Segment,
          .name = "segment",
          .category = kPrimitive,
          .params = {end_point("a", "an end, scene units"), end_point("b", "the other end, scene units"),
                     length("thickness", "to either side")},
          .doc = "a straight line with a thickness and round ends",
          .sort = Sort::Outline,
          .check = check_segment,
          .code = segment_code,
          .bound = [](Params p) { return hull(p.first(4)).grown(p[4]); },
          .facts = kAlongZ,
          .cancellation = segment_magnitude};
}

// True if q, a point of the line through a and b, lies between them.
bool between(dvec2 a, dvec2 b, dvec2 q) {
  return q.x >= std::min(a.x, b.x) && q.x <= std::max(a.x, b.x) && q.y >= std::min(a.y, b.y) &&
         q.y <= std::max(a.y, b.y);
}
// True if segments ab and cd have a point in common.
bool meet(dvec2 a, dvec2 b, dvec2 c, dvec2 d) {
  const double sc = cross(b - a, c - a), sd = cross(b - a, d - a), sa = cross(d - c, a - c), sb = cross(d - c, b - c);
  if (((sc > 0 && sd < 0) || (sc < 0 && sd > 0)) && ((sa > 0 && sb < 0) || (sa < 0 && sb > 0))) return true;
  return (sc == 0 && between(a, b, c)) || (sd == 0 && between(a, b, d)) || (sa == 0 && between(c, d, a)) ||
         (sb == 0 && between(c, d, b));
}
Corners polygon_corners(Params p) {
  Corners corners;
  for (std::size_t i = 0; i + 1 < p.size(); i += 2) corners.push_back(vec2_at(p, i));
  return corners;
}
ErrorText check_polygon(Params p) {
  const std::size_t n = p.size() / 2;
  if (n < 3) return fmt::format("`points` has {}; an outline needs at least 3", n);
  if (n > kMaxCorners) return fmt::format("`points` has {}; at most {} are possible", n, kMaxCorners);
  const auto at = [&](std::size_t i) { return vec2_at(p, 2 * (i % n)); };
  double area = 0, size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (at(i) == at(i + 1)) {
      return fmt::format("points {} and {} are the same; leave one out (the last joins the first by itself)", i,
                         (i + 1) % n);
    }
    area += cross(at(i) - at(0), at(i + 1) - at(0));
    size = std::max(size, glm::length(at(i) - at(0)));
  }
  for (std::size_t i = 0; i < n; ++i) {
    // Neighbouring edges share a point, so they overlap only if the next edge turns right back.
    const dvec2 edge = at(i + 1) - at(i), next = at(i + 2) - at(i + 1);
    if (cross(edge, next) == 0 && glm::dot(edge, next) < 0) {
      return fmt::format("the outline turns right back at point {}; leave that point out", (i + 1) % n);
    }
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n == i || !meet(at(i), at(i + 1), at(j), at(j + 1))) continue;
      return fmt::format("the edges after points {} and {} meet; give the corners in order around the outline", i, j);
    }
  }
  if (std::abs(area) <= 1e-12 * size * size) return "the points lie on one line; move one off it";
  return std::nullopt;
}
// Each edge is evaluated from its first corner, which near the surface is no further away than the polygon's size.
double polygon_magnitude(Params p) {
  const Box box = hull(p);
  return glm::length(dvec2(box.hi - box.lo));
}
NodeSpec polygon_row() {
  return {
      .kind = Kind::Polygon,
      .name = "polygon",
      .category = kPrimitive,
      .params = {{"points", ParamType::Points, Rule::Any, kRequired, "corners [x, y] in order around, either way"}},
      .doc = "straight edges from point to point and back to the first",
      .sort = Sort::Outline,
      .check = check_polygon,
      .code = code_of<Opcode::Polygon>,
      .bound = hull,
      .facts = kAlongZ,
      .cancellation = polygon_magnitude,
      .corners = polygon_corners};
}

std::vector<double> regular_polygon_immediates(Params p) {
  std::vector<double> k = sector_folds(static_cast<int>(p[0]));
  const vm::real::SinCos half = vm::real::sin_cos_degrees(180 / p[0]);
  k.insert(k.end(), {half.sin, half.cos, p[1]});
  return k;
}
Box regular_polygon_bound(Params p) {
  Box box;
  for (int i = 0; i < static_cast<int>(p[0]); ++i)
    box = unite(box, mirrored_hull({at_polar(p[1], 360.0 * i / p[0])}));
  return box;
}
Corners regular_polygon_corners(Params p) {
  Corners corners;
  for (int i = 0; i < static_cast<int>(p[0]); ++i) corners.push_back(at_polar(p[1], 360 * i / p[0]));
  return corners;
}
NodeSpec regular_polygon_row() {
  return {.kind = Kind::RegularPolygon,
          .name = "regular_polygon",
          .category = kPrimitive,
          .params = {{"sides", ParamType::Integer, Rule::Positive, kRequired, "3 to 64"},
                     length("radius", "of the corners; one is on +y")},
          .doc = "equal sides and angles",
          .sort = Sort::Outline,
          .check = [](Params p) { return check_sides(p[0], "sides"); },
          .code = code_of<Opcode::RegularPolygon, regular_polygon_immediates>,
          .bound = regular_polygon_bound,
          .facts = kUpright,
          .corners = regular_polygon_corners};
}

ErrorText check_star(Params p) {
  if (ErrorText complaint = check_sides(p[0], "points")) return complaint;
  if (p[2] < p[1]) return std::nullopt;
  return fmt::format("`inner_radius` {} is not smaller than `radius` {}; for no tips at all use `regular_polygon`",
                     p[2], p[1]);
}
std::vector<double> star_immediates(Params p) {
  std::vector<double> k = sector_folds(static_cast<int>(p[0]));
  const dvec2 edge = at_polar(p[2], 180 / p[0]) - dvec2(0, p[1]);
  const double length = glm::length(edge);
  // Between 30 and 150 degrees to the line through the centre the side of the edge is certain enough.
  const dvec2 outwards = at_polar(1, 180 / p[0]);
  const double sine = std::abs(cross(edge, outwards)) / length, sign = glm::dot(edge, outwards) < 0 ? -1e30 : 1e30;
  k.insert(k.end(), {edge.x / length, edge.y / length, length, p[1], sine > 0.5 ? 0 : sign});
  return k;
}
Box star_bound(Params p) {
  Box box;
  for (int i = 0; i < static_cast<int>(p[0]); ++i) {
    box = unite(box, mirrored_hull({at_polar(p[1], 360.0 * i / p[0]), at_polar(p[2], 180.0 * (2 * i + 1) / p[0])}));
  }
  return box;
}
Corners star_corners(Params p) {
  Corners corners;
  for (int i = 0; i < 2 * static_cast<int>(p[0]); ++i) corners.push_back(at_polar(p[i % 2 ? 2 : 1], 180 * i / p[0]));
  return corners;
}
NodeSpec star_row() {
  return {.kind = Kind::Star,
          .name = "star",
          .category = kPrimitive,
          .params = {{"points", ParamType::Integer, Rule::Positive, 5.0, "3 to 64"},
                     length("radius", "of the tips; one is on +y"),
                     length("inner_radius", "of the corners between, smaller")},
          .doc = "a star",
          .sort = Sort::Outline,
          .check = check_star,
          .code = code_of<Opcode::Star, star_immediates>,
          .bound = star_bound,
          .facts = kUpright,
          .cancellation = outline_magnitude<star_bound>,
          .corners = star_corners};
}

ErrorText check_trapezoid(Params p) {
  if (p[0] > 0 || p[1] > 0) return std::nullopt;
  return "both widths are 0; one of `bottom_half_width` and `top_half_width` must be positive";
}
Corners trapezoid_corners(Params p) { return {{p[0], -p[2]}, {p[1], p[2]}, {-p[1], p[2]}, {-p[0], -p[2]}}; }

Box trapezoid_bound(Params p) { return mirrored_hull({{p[0], -p[2]}, {p[1], p[2]}}); }
NodeSpec trapezoid_row() {
  return {.kind = Kind::Trapezoid,
          .name = "trapezoid",
          .category = kPrimitive,
          .params = {length_or_zero("bottom_half_width", "at y = -half_height"),
                     length_or_zero("top_half_width", "at y = half_height"), length("half_height", "along y")},
          .doc = "a symmetric trapezoid",
          .sort = Sort::Outline,
          .check = check_trapezoid,
          .code = [](Params p) { return one(Opcode::Trapezoid, slanted_profile(p[0], p[1], p[2])); },
          .bound = trapezoid_bound,
          .facts = kUpright,
          .corners = trapezoid_corners};
}

Code parallelogram_code(Params p) {
  const double side = std::sqrt(p[1] * p[1] + p[2] * p[2]);
  return one(Opcode::Parallelogram, {p[0], p[1], p[2], p[1] / side, -p[2] / side, side});
}
Box parallelogram_bound(Params p) {
  const dvec2 half(p[0] + std::abs(p[2]), p[1]);
  return planar_box(-half, half);
}
Corners parallelogram_corners(Params p) {
  return {{p[0] + p[2], p[1]}, {-p[0] + p[2], p[1]}, {-p[0] - p[2], -p[1]}, {p[0] - p[2], -p[1]}};
}
NodeSpec parallelogram_row() {
  return {.kind = Kind::Parallelogram,
          .name = "parallelogram",
          .category = kPrimitive,
          .params = {length("half_width", "of the sides along x"), length("half_height", "along y"),
                     number("skew", "how far the top is moved along +x and the bottom along -x", 0.0)},
          .doc = "a rectangle made oblique",
          .sort = Sort::Outline,
          .code = parallelogram_code,
          .bound = parallelogram_bound,
          .facts = kAlongZ,
          .corners = parallelogram_corners};
}

Code diamond_code(Params p) {
  const double side = std::sqrt(p[0] * p[0] + p[1] * p[1]);
  return one(Opcode::Diamond, {p[1] / side, p[0] / side, p[0] * p[1] / side, p[0], side});
}
Corners diamond_corners(Params p) { return {{p[0], 0}, {0, p[1]}, {-p[0], 0}, {0, -p[1]}}; }
NodeSpec diamond_row() {
  return {.kind = Kind::RhombusOutline,
          .name = "diamond",
          .category = kPrimitive,
          .params = {length("half_width", "of the corners on the x axis"),
                     length("half_height", "of the corners on the y axis")},
          .doc = "a rhombus, corners on the axes",
          .sort = Sort::Outline,
          .code = diamond_code,
          .bound = half_sizes_bound,
          .facts = kSymmetric,
          .corners = diamond_corners};
}

Code isosceles_triangle_code(Params p) {
  std::vector<double> k = slanted_profile(0, p[0], p[1] / 2);
  k.push_back(p[1] / 2);
  return one(Opcode::IsoscelesTriangle, k);
}
Box isosceles_triangle_bound(Params p) { return mirrored_hull({{0, 0}, {p[0], p[1]}}); }

Corners isosceles_triangle_corners(Params p) { return {{0, 0}, {p[0], p[1]}, {-p[0], p[1]}}; }
NodeSpec isosceles_triangle_row() {
  return {.kind = Kind::IsoscelesTriangle,
          .name = "isosceles_triangle",
          .category = kPrimitive,
          .params = {length("half_width", "of the base, at y = height"),
                     length("height", "of the base above the apex, which is the origin")},
          .doc = "a symmetric triangle on its apex",
          .sort = Sort::Outline,
          .code = isosceles_triangle_code,
          .bound = isosceles_triangle_bound,
          .facts = kUpright,
          .cancellation = outline_magnitude<isosceles_triangle_bound>,
          .corners = isosceles_triangle_corners};
}

}  // namespace

std::vector<NodeSpec> outline_rows() {
  return {circle_row(),  rectangle_row(),         rounded_rectangle_row(),
          segment_row(), polygon_row(),           regular_polygon_row(),
          star_row(),    trapezoid_row(),         parallelogram_row(),
          diamond_row(), isosceles_triangle_row()};
}

}  // namespace fathom::compiler
