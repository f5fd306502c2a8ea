#include "compiler/shapes/solid_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numbers>

#include "compiler/geometry/direction.h"
#include "compiler/geometry/sine_cosine.h"

namespace fathom::compiler {
namespace {

using glm::dvec2;
using glm::dvec3;

dvec3 vec3_at(Params p, std::size_t i) { return {p[i], p[i + 1], p[i + 2]}; }

// Returns the corners of a triangle or quad, whose last parameter is the thickness.
std::vector<dvec3> corners(Params p) {
  std::vector<dvec3> result;
  for (std::size_t i = 0; i + 3 <= p.size(); i += 3) result.push_back(vec3_at(p, i));
  return result;
}

double longest_side(const std::vector<dvec3>& v) {
  double longest = 0;
  for (std::size_t i = 0; i < v.size(); ++i) longest = std::max(longest, glm::length(v[(i + 1) % v.size()] - v[i]));
  return longest;
}

// Returns twice the polygon's area as a vector along its normal (Newell's method).
dvec3 area_vector(const std::vector<dvec3>& v) {
  dvec3 sum(0.0);
  for (std::size_t i = 0; i < v.size(); ++i) sum += glm::cross(v[i] - v[0], v[(i + 1) % v.size()] - v[0]);
  return sum;
}

constexpr const char* kCornerNames = "abcd";

// Returns the radius of a ball that contains the Mandelbulb: beyond |p| = 2^(1/(n-1)) <= 2 every orbit w -> w^n + p
// escapes, because |w| >= |p| grows. Uses Newton's method on r^(n-1) = 2, because libm's pow differs between
// machines.
double escape_radius(double power) {
  double r = 2;
  for (int i = 0; i < 64; ++i) {
    double rest = 1;  // r^(n-2)
    for (int k = 0; k < static_cast<int>(power) - 2; ++k) rest *= r;
    r -= (r - 2 / rest) / (power - 1);
  }
  return r;
}

// Returns R with R^2 - |c| = R. No orbit of q -> q^2 + c returns from beyond |q| = R, because |q^2 + c| >= |q|^2 -
// |c| > |q| there.
double julia_escape_radius(Params p) {
  const double c = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
  return (1 + std::sqrt(1 + 4 * c)) / 2;
}

// Returns the corners moved into one plane exactly: a quad's may be off by the tolerance of check_quad().
std::vector<dvec3> flat_corners(Params p) {
  std::vector<dvec3> v = corners(p);
  const dvec3 normal = glm::normalize(area_vector(v));
  for (dvec3& corner : v) corner -= glm::dot(corner - v[0], normal) * normal;
  return v;
}

Complaint check_sheet(const std::vector<dvec3>& v) {
  const double scale = longest_side(v);
  for (std::size_t i = 0; i < v.size(); ++i) {
    for (std::size_t j = i + 1; j < v.size(); ++j) {
      if (glm::length(v[i] - v[j]) <= 1e-9 * scale) {
        return fmt::format("corners `{}` and `{}` coincide; give distinct corners", kCornerNames[i], kCornerNames[j]);
      }
    }
  }
  if (glm::length(area_vector(v)) <= 1e-9 * scale * scale) {
    return "the corners lie on one line; move one off it";
  }
  return std::nullopt;
}

}  // namespace

Complaint check_round_box(Params p) {
  const double smallest = std::min({p[0], p[1], p[2]});
  if (p[3] <= smallest) return std::nullopt;
  return fmt::format("`radius` {} is larger than the smallest half size {}; the rounding is part of the half size",
                     p[3], smallest);
}

Complaint check_rounded_cylinder(Params p) {
  const double smallest = std::min(p[0], p[1]);
  if (p[2] <= smallest) return std::nullopt;
  return fmt::format("`rounding` {} is larger than {}, the smaller of `radius` and `half_height`; it is part of both",
                     p[2], smallest);
}

Complaint check_cone(Params p) {
  if (p[0] > 0 || p[1] > 0) return std::nullopt;
  return "both radii are 0; one of `bottom_radius` and `top_radius` must be positive";
}

Complaint check_round_cone(Params p) {
  if (std::abs(p[0] - p[1]) <= p[2]) return std::nullopt;
  return fmt::format("the radii differ by {}, more than `height` {}: one ball holds the other; use a sphere",
                     std::abs(p[0] - p[1]), p[2]);
}

Complaint check_triangle(Params p) { return check_sheet(corners(p)); }

Complaint check_quad(Params p) {
  const std::vector<dvec3> v = corners(p);
  if (Complaint complaint = check_sheet(v)) return complaint;
  const dvec3 normal = glm::normalize(area_vector(v));
  const double scale = longest_side(v);
  const double out = std::abs(glm::dot(v[3] - v[0], glm::normalize(glm::cross(v[1] - v[0], v[2] - v[0]))));
  if (!(out <= 1e-6 * scale)) {
    return fmt::format("corner `d` is {:.3g} off the plane of `a`, `b` and `c`; use two triangles", out);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec3 before = v[i] - v[(i + 3) % 4], after = v[(i + 1) % 4] - v[i];
    if (glm::dot(glm::cross(before, after), normal) <= 0) {
      return fmt::format(
          "the corner at `{}` is not convex; give the corners in order around a convex shape, or use two "
          "triangles",
          kCornerNames[i]);
    }
  }
  return std::nullopt;
}

Complaint check_mandelbulb(Params p) {
  if (p[0] < 2 || p[0] > 24) return fmt::format("`power` is {}; it must be a whole number from 2 to 24", p[0]);
  if (p[1] > 256) return fmt::format("`iterations` is {}; it must be a whole number from 1 to 256", p[1]);
  // |w|^2 after the escaping iteration is about bailout^(2 power) and must fit into a float.
  const double largest = std::floor(std::pow(10.0, 18 / p[0]));
  if (p[2] < 2 || p[2] > largest) {
    return fmt::format("`bailout` is {}; for power {} it must be between 2 and {}", p[2], p[0], largest);
  }
  return std::nullopt;
}

Complaint check_box_frame(Params p) {
  const double smallest = std::min({p[0], p[1], p[2]});
  if (2 * p[3] <= smallest) return std::nullopt;
  return fmt::format(
      "`thickness` {} is more than {}, half the smallest half size: the bars, 2 * `thickness` wide, "
      "would overlap; use a box",
      p[3], smallest / 2);
}

Complaint check_capped_torus(Params p) {
  if (p[2] <= 180) return std::nullopt;
  return fmt::format("`angle` is {}; it is half of what remains of the ring, at most 180 degrees", p[2]);
}

Complaint check_half_angle(Params p) {
  if (p[0] < 90) return std::nullopt;
  return fmt::format("`angle` is {}; it is measured from the axis to the side and must be below 90 degrees", p[0]);
}

Complaint check_menger_sponge(Params p) {
  if (p[1] <= 8) return std::nullopt;
  return fmt::format("`iterations` is {}; it must be a whole number from 1 to 8", p[1]);
}

Complaint check_julia(Params p) {
  if (p[4] > 256) return fmt::format("`iterations` is {}; it must be a whole number from 1 to 256", p[4]);
  // |q|^2 after the escaping iteration is about bailout^4 and must fit into a float.
  constexpr double kLargestRadius = 1e6;
  const double radius = julia_escape_radius(p);
  if (radius > kLargestRadius) return fmt::format("`c` is too large; every orbit escapes from beyond {:.3g}", radius);
  if (p[5] < radius || p[5] > kLargestRadius) {
    return fmt::format("`bailout` is {}; for this `c` it must be between {:.6g} and {}", p[5], radius, kLargestRadius);
  }
  return std::nullopt;
}

std::vector<double> mandelbulb_immediates(Params p) { return {p[0], p[1], p[2], escape_radius(p[0]), p[3]}; }

std::vector<double> round_box_immediates(Params p) { return {p[0] - p[3], p[1] - p[3], p[2] - p[3], p[3]}; }

std::vector<double> box_frame_immediates(Params p) {
  return {p[0], p[1], p[2], p[0] - 2 * p[3], p[1] - 2 * p[3], p[2] - 2 * p[3]};
}

std::vector<double> capped_torus_immediates(Params p) {
  const auto [sine, cosine] = sine_cosine(p[2]);
  return {p[0], p[1], sine, cosine};
}

std::vector<double> infinite_cone_immediates(Params p) {
  const auto [sine, cosine] = sine_cosine(p[0]);
  return {sine, cosine};
}

// Returns radians per scene unit, and the factor that brings the largest slope, sqrt 3 times that number, to 1.
std::vector<double> periodic_immediates(Params p) {
  const double k = 2 * std::numbers::pi / p[0];
  return {k, 1 / (std::numbers::sqrt3 * k)};
}

std::vector<double> julia_immediates(Params p) {
  return {p[0], p[1], p[2], p[3], p[4], julia_escape_radius(p), p[5], p[6]};
}

std::vector<double> plane_immediates(Params p) {
  const dvec3 n = direction(vec3_at(p, 0));
  return {n.x, n.y, n.z, p[3]};
}

std::vector<double> rounded_cylinder_immediates(Params p) { return {p[0] - p[2], p[1] - p[2], p[2]}; }

// Returns the cone's sizes, the side's outward normal in the half-plane (distance from the axis, y), and its length.
std::vector<double> cone_immediates(Params p) {
  const double bottom = p[0], top = p[1], half_height = p[2];
  const double slant = std::sqrt(4 * half_height * half_height + (bottom - top) * (bottom - top));
  return {half_height, bottom, top, 2 * half_height / slant, (bottom - top) / slant, slant};
}

// The side touches both balls, so its outward normal in the half-plane is (sqrt(1 - b^2), b) with b = (r1 - r2) / h.
std::vector<double> round_cone_immediates(Params p) {
  const double b = (p[0] - p[1]) / p[2];
  // Balls that touch from inside (b = +-1) have no side. A normal of not quite 0 keeps the cases apart on the axis.
  return {p[0], p[1], p[2], std::max(1e-30, std::sqrt((1 - b) * (1 + b))), b};
}

// Returns a frame with the first corner at its origin, the first edge along x and the normal along z; the length of
// the first edge; for each further edge its start, its direction and its length in the frame's xy plane; the
// thickness.
std::vector<double> sheet_immediates(Params p) {
  const std::vector<dvec3> v = flat_corners(p);
  const dvec3 z = glm::normalize(area_vector(v));
  const dvec3 x = glm::normalize(v[1] - v[0]);
  const dvec3 y = glm::cross(z, x);
  std::vector<double> result;
  for (const dvec3& axis : {x, y, z}) {
    result.insert(result.end(), {axis.x, axis.y, axis.z, -glm::dot(axis, v[0])});
  }
  result.push_back(glm::length(v[1] - v[0]));
  for (std::size_t i = 1; i < v.size(); ++i) {
    const dvec3 start = v[i] - v[0], edge = v[(i + 1) % v.size()] - v[i];
    const double length = glm::length(edge);
    result.insert(result.end(), {glm::dot(start, x), glm::dot(start, y), glm::dot(edge, x) / length,
                                 glm::dot(edge, y) / length, length});
  }
  result.push_back(p.back());
  return result;
}

Box sphere_bound(Params p) { return Box::centred(dvec3(p[0])); }
Box half_size_bound(Params p) { return Box::centred(vec3_at(p, 0)); }
Box torus_bound(Params p) { return Box::centred({p[0] + p[1], p[1], p[0] + p[1]}); }

// A half space is bounded on one side if its normal is along an axis.
Box plane_bound(Params p) {
  Box box = Box::everything();
  const std::vector<double> plane = plane_immediates(p);
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    if (plane[axis] == 1) box.hi[i] = plane[3];
    if (plane[axis] == -1) box.lo[i] = -plane[3];
  }
  return box;
}

Box cylinder_bound(Params p) { return Box::centred({p[0], p[1], p[0]}); }

Box cone_bound(Params p) {
  const double radius = std::max(p[0], p[1]);
  return Box::centred({radius, p[2], radius});
}

Box round_cone_bound(Params p) {
  const double radius = std::max(p[0], p[1]);
  return {{-radius, std::min(-p[0], p[2] - p[1]), -radius}, {radius, std::max(p[0], p[2] + p[1]), radius}};
}

Box sheet_bound(Params p) {
  Box box;
  for (const dvec3& corner : flat_corners(p)) box = unite(box, {corner, corner});
  return box.grown(p.back());
}

// Triangles and quads are evaluated from their corners, which near the surface are no further away than their size.
double sheet_magnitude(Params p) {
  const Box box = sheet_bound(p);
  return glm::length(box.hi - box.lo);
}
// Near the inner side of a fat ring, the centre line is much further away than the origin.
double torus_magnitude(Params p) { return std::min(p[0], p[1]); }

// The estimate is at least about a quarter of the distance from the set.
Box mandelbulb_bound(Params p) { return Box::centred(dvec3(escape_radius(p[0]) + 4 * p[3])); }

Box capped_torus_bound(Params p) {
  const auto [sine, cosine] = sine_cosine(p[2]);
  const double side = p[2] < 90 ? p[0] * sine + p[1] : p[0] + p[1];
  return {{-side, p[0] * cosine - p[1], -p[1]}, {side, p[0] + p[1], p[1]}};
}

Box infinite_cylinder_bound(Params p) { return Box::centred({p[0], std::numeric_limits<double>::infinity(), p[0]}); }

Box infinite_cone_bound(Params) {
  Box box = Box::everything();
  box.hi.y = 0;
  return box;
}

Box capsule_bound(Params p) { return Box::centred({p[0], p[0] + p[1], p[0]}); }

Box everywhere(Params) { return Box::everything(); }

Box menger_sponge_bound(Params p) { return Box::centred(dvec3(p[0])); }

// The estimate is at least the distance from the ball.
Box julia_bound(Params p) { return Box::centred(dvec3(julia_escape_radius(p) + p[6])); }

}  // namespace fathom::compiler
