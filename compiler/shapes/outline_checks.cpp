// Checks that the parameters of an outline fit together.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/geometry/sine_cosine.h"
#include "compiler/shapes/outline_facts.h"
#include "compiler/shapes/vec2.h"

namespace fathom::compiler {
namespace {

using glm::dvec2;

Complaint check_angle(double angle, bool closed, const char* other) {
  if (angle > 0 && (angle < 180 || (closed && angle == 180))) return std::nullopt;
  return fmt::format("`angle` is {}; it must be above 0 and {} 180{}", angle, closed ? "at most" : "below", other);
}
Complaint check_sides(double sides, const char* name) {
  if (sides >= 3 && sides <= 64) return std::nullopt;
  return fmt::format("`{}` is {}; it must be a whole number from 3 to 64", name, sides);
}
Complaint check_thickness(double thickness, double radius, const char* other) {
  if (thickness < radius) return std::nullopt;
  return fmt::format("`thickness` {} is not smaller than `radius` {}, which leaves no hole; use `{}`", thickness,
                     radius, other);
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

}  // namespace

Complaint check_rounded_rectangle(Params p) {
  const double smallest = std::min(p[0], p[1]);
  if (p[2] <= smallest) return std::nullopt;
  return fmt::format("`radius` {} is larger than the smallest half size {}; the rounding is part of the half size",
                     p[2], smallest);
}

Complaint check_segment(Params p) {
  if (vec2_at(p, 0) != vec2_at(p, 2)) return std::nullopt;
  return "ends `a` and `b` coincide; use `circle`";
}

Complaint check_polygon(Params p) {
  const std::size_t n = p.size() / 2;
  if (n < 3) return fmt::format("`points` has {}; an outline needs at least 3", n);
  constexpr std::size_t kMostCorners = 4096;
  if (n > kMostCorners) return fmt::format("`points` has {}; at most {} are possible", n, kMostCorners);
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

Complaint check_regular_polygon(Params p) { return check_sides(p[0], "sides"); }

Complaint check_star(Params p) {
  if (Complaint complaint = check_sides(p[0], "points")) return complaint;
  if (p[2] < p[1]) return std::nullopt;
  return fmt::format("`inner_radius` {} is not smaller than `radius` {}; for no tips at all use `regular_polygon`",
                     p[2], p[1]);
}

Complaint check_trapezoid(Params p) {
  if (p[0] > 0 || p[1] > 0) return std::nullopt;
  return "both widths are 0; one of `bottom_half_width` and `top_half_width` must be positive";
}

Complaint check_uneven_capsule(Params p) {
  if (std::abs(p[0] - p[1]) <= p[2]) return std::nullopt;
  return fmt::format("the radii differ by {}, more than `height` {}: one disk holds the other; use `circle`",
                     std::abs(p[0] - p[1]), p[2]);
}

Complaint check_arc(Params p) {
  if (Complaint complaint = check_angle(p[1], true, ", a full circle")) return complaint;
  return check_thickness(p[2], p[0], p[1] == 180 ? "circle" : "pie");
}

Complaint check_pie(Params p) { return check_angle(p[1], true, ", a full disk"); }

Complaint check_cut_disk(Params p) {
  if (std::abs(p[1]) < p[0]) return std::nullopt;
  return fmt::format("`height` {} is not within the disk of `radius` {}: {}", p[1], p[0],
                     p[1] > 0 ? "nothing is cut off; use `circle`" : "nothing is left");
}

Complaint check_horseshoe(Params p) {
  if (Complaint complaint = check_angle(p[1], false, "")) return complaint;
  if (Complaint complaint = check_thickness(p[3], p[0], "pie")) return complaint;
  const SineCosine at = sine_cosine(p[1]);
  const double inner = p[0] - p[3], clear = inner * at.sine + std::min(0.0, p[2] * at.cosine);
  if (clear >= 0) return std::nullopt;
  return fmt::format("the legs cross each other: give a `length` of at most {:.6g}, or a smaller `angle`",
                     inner * at.sine / -at.cosine);
}

Complaint check_lens(Params p) {
  if (p[1] < p[0]) return std::nullopt;
  return fmt::format(
      "`half_width` {} is not smaller than `half_height` {}; exchange them and turn it with rotate, or make it round",
      p[1], p[0]);
}

Complaint check_moon(Params p) {
  const double radius = p[0], cut = p[1], distance = p[2];
  const char* others = "`radius`, `cut_radius` and `distance` do not fit together: ";
  if (distance >= radius + cut) return fmt::format("{}the cut is outside the disk; use `circle`", others);
  if (cut >= radius + distance) return fmt::format("{}the cut holds the whole disk; nothing is left", others);
  if (radius >= cut + distance) {
    return fmt::format("{}the cut is a hole within the disk; use `subtraction` of two circles", others);
  }
  return std::nullopt;
}

Complaint check_egg(Params p) {
  if (!(p[1] < p[0])) {
    return fmt::format("`top_radius` {} is not smaller than `bottom_radius` {}; use `uneven_capsule`", p[1], p[0]);
  }
  if (p[2] > p[0] - p[1]) return std::nullopt;
  return fmt::format(
      "`height` {} is not larger than {}, by how much the radii differ: the bottom holds the top; use "
      "`circle`",
      p[2], p[0] - p[1]);
}

Complaint check_cross(Params p) {
  if (p[1] < p[0]) return std::nullopt;
  return fmt::format("`half_width` {} is not smaller than `half_length` {}; use `rectangle`", p[1], p[0]);
}

// The inner corners between the arms exist while the arms' ends lie beyond them: radius <= sqrt 2 (half size -
// radius).
Complaint check_rounded_x(Params p) {
  const double most = p[0] * std::numbers::sqrt2 / (1 + std::numbers::sqrt2);
  if (p[1] <= most) return std::nullopt;
  return fmt::format(
      "`radius` {} is larger than {:.6g}, for which the arms of `half_size` {} fill what is between them", p[1], most,
      p[0]);
}

}  // namespace fathom::compiler
