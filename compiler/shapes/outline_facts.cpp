#include "compiler/shapes/outline_facts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>

#include "compiler/geometry/sine_cosine.h"
#include "compiler/shapes/rows.h"
#include "compiler/shapes/solid_facts.h"
#include "compiler/shapes/vec2.h"

namespace fathom::compiler {
namespace {

using glm::dvec2;
using vm::Opcode;

Box box_2d(dvec2 lo, dvec2 hi) { return {{lo.x, lo.y, -kInfinity}, {hi.x, hi.y, kInfinity}}; }
// Returns the box of points and their mirror images across x = 0.
Box mirrored_hull(std::initializer_list<dvec2> points) {
  Box box;
  for (dvec2 q : points) {
    q.x = std::abs(q.x);
    box = unite(box, box_2d({-q.x, q.y}, q));
  }
  return box;
}
Box hull(Params points) {
  Box box;
  for (std::size_t i = 0; i + 1 < points.size(); i += 2)
    box = unite(box, box_2d(vec2_at(points, i), vec2_at(points, i)));
  return box;
}

// Returns the point at a distance from the origin, at an angle in degrees from +y towards +x.
dvec2 polar(double radius, double degrees) {
  const SineCosine at = sine_cosine(degrees);
  return {radius * at.sine, radius * at.cosine};
}

// Returns the box of the part of a circle about the origin that is at most `angle` from +y.
Box arc_box(double radius, double angle) {
  const dvec2 end = polar(radius, angle);
  return mirrored_hull({{0, radius}, {angle >= 90 ? radius : end.x, radius}, end});
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
    const SineCosine line = sine_cosine(180.0 * sectors / n);
    normals.insert(normals.end(), {-line.cosine, line.sine});
  }
  return normals;
}

// Returns the point, x > 0, where the circles of a moon meet.
dvec2 moon_corner(double radius, double cut, double distance) {
  const double y = ((radius - cut) * (radius + cut) + distance * distance) / (2 * distance);
  return {std::sqrt((radius - y) * (radius + y)), y};
}

// Returns a slanted profile between y = -half_height and half_height, like cone_immediates().
std::vector<double> profile(double bottom, double top, double half_height) {
  const double p[] = {bottom, top, half_height};
  return cone_immediates(p);
}

// Returns c: an egg's side is an arc about (-c, 0) that touches the bottom from outside, and c^2 + height^2 = (c +
// bottom - top)^2.
double egg_centre(Params p) {
  const double less = p[0] - p[1];
  return (p[2] - less) * (p[2] + less) / (2 * less);
}

}  // namespace

std::vector<double> rounded_rectangle_immediates(Params p) { return {p[0] - p[2], p[1] - p[2], p[2]}; }

std::vector<double> segment_immediates(Params p) {
  const dvec2 way = vec2_at(p, 2) - vec2_at(p, 0);
  const double length = glm::length(way);
  return {p[0], p[1], way.x / length, way.y / length, length, p[4]};
}

std::vector<double> regular_polygon_immediates(Params p) {
  std::vector<double> k = sector_folds(static_cast<int>(p[0]));
  const SineCosine half = sine_cosine(180 / p[0]);
  k.insert(k.end(), {half.sine, half.cosine, p[1]});
  return k;
}

std::vector<double> star_immediates(Params p) {
  std::vector<double> k = sector_folds(static_cast<int>(p[0]));
  const dvec2 edge = polar(p[2], 180 / p[0]) - dvec2(0, p[1]);
  const double length = glm::length(edge);
  // Between 30 and 150 degrees to the line through the centre the side of the edge is certain enough.
  const dvec2 outwards = polar(1, 180 / p[0]);
  const double sine = std::abs(cross(edge, outwards)) / length, sign = glm::dot(edge, outwards) < 0 ? -1e30 : 1e30;
  k.insert(k.end(), {edge.x / length, edge.y / length, length, p[1], sine > 0.5 ? 0 : sign});
  return k;
}

std::vector<double> trapezoid_immediates(Params p) { return profile(p[0], p[1], p[2]); }

std::vector<double> parallelogram_immediates(Params p) {
  const double side = std::sqrt(p[1] * p[1] + p[2] * p[2]);
  return {p[0], p[1], p[2], p[1] / side, -p[2] / side, side};
}

std::vector<double> diamond_immediates(Params p) {
  const double side = std::sqrt(p[0] * p[0] + p[1] * p[1]);
  return {p[1] / side, p[0] / side, p[0] * p[1] / side, p[0], side};
}

std::vector<double> isosceles_triangle_immediates(Params p) {
  std::vector<double> k = profile(0, p[0], p[1] / 2);
  k.push_back(p[1] / 2);
  return k;
}

std::vector<double> arc_immediates(Params p) {
  const SineCosine at = sine_cosine(p[1]);
  return {p[0], p[2], at.sine, at.cosine, p[0] * at.sine, p[0] * at.cosine};
}

std::vector<double> cut_disk_immediates(Params p) { return {p[0], p[1], std::sqrt((p[0] - p[1]) * (p[0] + p[1]))}; }

std::vector<double> horseshoe_immediates(Params p) {
  const SineCosine at = sine_cosine(p[1]);
  return {p[0], p[3], at.sine, at.cosine, p[2], p[0] - p[3], p[0] + p[3]};
}

std::vector<double> lens_immediates(Params p) {
  const double h = p[0], w = p[1], radius = (h * h + w * w) / (2 * w), centre = (h - w) * (h + w) / (2 * w);
  return {h, centre, radius, centre / radius, h / radius};
}

std::vector<double> moon_immediates(Params p) {
  const dvec2 corner = moon_corner(p[0], p[1], p[2]);
  const dvec2 of_disk = corner / p[0], of_cut = (dvec2(0, p[2]) - corner) / p[1];
  return {p[0], p[1], p[2], corner.x, corner.y, of_disk.x, of_disk.y, of_cut.x, of_cut.y};
}

std::vector<double> egg_immediates(Params p) {
  const double centre = egg_centre(p), radius = centre + p[0], to_top = radius - p[1];
  return {p[0], p[1], p[2], centre, radius, centre / to_top, p[2] / to_top};
}

std::vector<double> rounded_x_immediates(Params p) { return {p[1], std::numbers::sqrt2 * (p[0] - p[1])}; }

std::vector<double> ellipse_immediates(Params p) {
  const double major = std::max(p[0], p[1]), minor = std::min(p[0], p[1]);
  return {major, minor, (major - minor) * (major + minor), p[1] > p[0] ? 1.0 : 0.0};
}

Code ring_code(Params p) {
  if (p[1] == 180) return code_of<Opcode::Arc, arc_immediates>(p);
  const SineCosine at = sine_cosine(p[1]);
  return one(Opcode::Ring, {p[0], p[2], at.sine, at.cosine, p[0] - p[2], p[0] + p[2]});
}

Code pie_code(Params p) {
  if (p[1] == 180) return one(Opcode::Circle, {p[0]});
  const SineCosine at = sine_cosine(p[1]);
  return one(Opcode::Pie, {p[0], at.sine, at.cosine});
}

Box square_bound(Params p) { return box_2d(dvec2(-p[0]), dvec2(p[0])); }
Box half_sizes_bound(Params p) { return box_2d(-vec2_at(p, 0), vec2_at(p, 0)); }
Box segment_bound(Params p) { return hull(p.first(4)).grown(p[4]); }
Box polygon_bound(Params p) { return hull(p); }

Box regular_polygon_bound(Params p) {
  Box box;
  for (int i = 0; i < static_cast<int>(p[0]); ++i) box = unite(box, mirrored_hull({polar(p[1], 360.0 * i / p[0])}));
  return box;
}

Box star_bound(Params p) {
  Box box;
  for (int i = 0; i < static_cast<int>(p[0]); ++i) {
    box = unite(box, mirrored_hull({polar(p[1], 360.0 * i / p[0]), polar(p[2], 180.0 * (2 * i + 1) / p[0])}));
  }
  return box;
}

Box trapezoid_bound(Params p) { return mirrored_hull({{p[0], -p[2]}, {p[1], p[2]}}); }
Box parallelogram_bound(Params p) {
  const dvec2 half(p[0] + std::abs(p[2]), p[1]);
  return box_2d(-half, half);
}
Box isosceles_triangle_bound(Params p) { return mirrored_hull({{0, 0}, {p[0], p[1]}}); }
Box uneven_capsule_bound(Params p) {
  const double radius = std::max(p[0], p[1]);
  return box_2d({-radius, std::min(-p[0], p[2] - p[1])}, {radius, std::max(p[0], p[2] + p[1])});
}
Box arc_bound(Params p) { return arc_box(p[0], p[1]).grown(p[2]); }
Box ring_bound(Params p) { return unite(arc_box(p[0] + p[2], p[1]), mirrored_hull({polar(p[0] - p[2], p[1])})); }
Box pie_bound(Params p) { return unite(arc_box(p[0], p[1]), mirrored_hull({dvec2(0)})); }
Box cut_disk_bound(Params p) {
  const double chord = std::sqrt((p[0] - p[1]) * (p[0] + p[1]));
  return mirrored_hull({{0, -p[0]}, {p[1] >= 0 ? p[0] : chord, p[1]}});
}
Box horseshoe_bound(Params p) {
  const SineCosine at = sine_cosine(p[1]);
  const dvec2 leg = p[2] * dvec2(at.cosine, -at.sine);
  const dvec2 outer = polar(p[0] + p[3], p[1]), inner = polar(p[0] - p[3], p[1]);
  return unite(arc_box(p[0] + p[3], p[1]), mirrored_hull({inner, outer + leg, inner + leg}));
}
Box lens_bound(Params p) { return box_2d({-p[1], -p[0]}, {p[1], p[0]}); }
// The part of the disk that remains lies below the corners.
Box moon_bound(Params p) {
  const dvec2 corner = moon_corner(p[0], p[1], p[2]);
  return mirrored_hull({{0, -p[0]}, {corner.y >= 0 ? p[0] : corner.x, corner.y}});
}
Box egg_bound(Params p) { return box_2d({-p[0], -p[0]}, {p[0], p[2] + p[1]}); }
Box heart_bound(Params p) {
  const double radius = p[0] * std::numbers::sqrt2 / 4;
  return mirrored_hull({{0, 0}, {0.25 * p[0] + radius, 0.75 * p[0] + radius}});
}

// The segment is evaluated from its first end, whose distance from zero counts, or the segment's size if smaller.
double segment_magnitude(Params p) {
  return std::min(std::max(std::abs(p[0]), std::abs(p[1])), glm::length(vec2_at(p, 2) - vec2_at(p, 0)) + p[4]);
}
// Each edge is evaluated from its first corner, which near the surface is no further away than the polygon's size.
double polygon_magnitude(Params p) {
  const Box box = polygon_bound(p);
  return glm::length(dvec2(box.hi - box.lo));
}
// The cut's circle is evaluated from its own centre.
double moon_magnitude(Params p) { return p[2]; }

}  // namespace fathom::compiler
