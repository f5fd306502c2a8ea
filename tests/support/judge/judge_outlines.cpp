#include "tests/support/judge/judge_outlines.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "tests/support/judge/judge_geometry.h"
#include "vm/program/check.h"

namespace fathom::test {
namespace {

using compiler::Kind;
using glm::dvec2;

constexpr double kSqrt2 = std::numbers::sqrt2;


// Point at distance `radius` from the origin, `angle` radians from +y towards +x.
dvec2 polar(double radius, double angle) { return {radius * std::sin(angle), radius * std::cos(angle)}; }

Piece line(dvec2 a, dvec2 b) { return {true, a, b, {}, {}, 0, 0}; }
Piece arc(dvec2 centre, double radius, double from, double to) {
  return {false, {}, {}, centre, dvec2(radius), from, to};
}
Piece circle(double radius) { return arc(dvec2(0), radius, 0, 2 * kPi); }
// Arc around +y, `angle` to either side.
Piece arc_about_y(double radius, double angle) { return arc(dvec2(0), radius, kPi / 2 - angle, kPi / 2 + angle); }
// The part of a circle below its points at `angle` above +x and above -x.
Piece arc_below(dvec2 centre, double radius, double angle) {
  return arc(centre, radius, kPi - angle, 2 * kPi + angle);
}

dvec2 mirrored(dvec2 v) { return {-v.x, v.y}; }
Piece mirrored(Piece piece) {
  return {piece.straight, mirrored(piece.a), mirrored(piece.b), mirrored(piece.centre),
          piece.radii,    kPi - piece.to,    kPi - piece.from};
}
std::vector<Piece> with_mirror_images(std::vector<Piece> pieces) {
  const std::size_t n = pieces.size();
  for (std::size_t i = 0; i < n; ++i) pieces.push_back(mirrored(pieces[i]));
  return pieces;
}

std::vector<Piece> closed(const std::vector<dvec2>& corners) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    pieces.push_back(line(corners[i], corners[(i + 1) % corners.size()]));
  }
  return pieces;
}

// Corners of a shape with straight edges only; empty for other shapes.
std::vector<dvec2> corners(Kind kind, Params k) {
  std::vector<dvec2> v;
  switch (kind) {
    case Kind::Rectangle:
      return {{k[0], k[1]}, {-k[0], k[1]}, {-k[0], -k[1]}, {k[0], -k[1]}};
    case Kind::Polygon:
      for (std::size_t i = 0; i < k.size(); i += 2) v.push_back(vec2_at(k, i));
      return v;
    case Kind::RegularPolygon:
      for (int i = 0; i < static_cast<int>(k[0]); ++i) v.push_back(polar(k[1], 2 * kPi * i / k[0]));
      return v;
    case Kind::Star:
      for (int i = 0; i < 2 * static_cast<int>(k[0]); ++i) v.push_back(polar(k[1 + i % 2], kPi * i / k[0]));
      return v;
    case Kind::Trapezoid:
      return {{k[0], -k[2]}, {k[1], k[2]}, {-k[1], k[2]}, {-k[0], -k[2]}};
    case Kind::Parallelogram:
      return {{k[0] + k[2], k[1]}, {-k[0] + k[2], k[1]}, {-k[0] - k[2], -k[1]}, {k[0] - k[2], -k[1]}};
    case Kind::RhombusOutline:
      return {{k[0], 0}, {0, k[1]}, {-k[0], 0}, {0, -k[1]}};
    case Kind::IsoscelesTriangle:
      return {{0, 0}, {k[0], k[1]}, {-k[0], k[1]}};
    case Kind::Cross:
      for (const dvec2 turn : {dvec2(1, 0), dvec2(0, 1), dvec2(-1, 0), dvec2(0, -1)}) {
        for (const dvec2 at : {dvec2(k[0], -k[1]), dvec2(k[0], k[1]), dvec2(k[1], k[1])}) {
          v.push_back({turn.x * at.x - turn.y * at.y, turn.y * at.x + turn.x * at.y});
        }
      }
      return v;
    default:
      return v;
  }
}

bool within_polygon(const std::vector<dvec2>& v, dvec2 p) {
  bool inside = false;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const dvec2 a = v[i], b = v[(i + 1) % v.size()];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

// Normal of the straight side of an uneven capsule, which touches both disks.
dvec2 side_normal(Params k) {
  const double s = (k[0] - k[1]) / k[2];
  return {std::sqrt((1 - s) * (1 + s)), s};
}

dvec2 moon_corner(Params k) {
  const double y = ((k[0] - k[1]) * (k[0] + k[1]) + k[2] * k[2]) / (2 * k[2]);
  return {std::sqrt((k[0] - y) * (k[0] + y)), y};
}

// The side of an egg is an arc about (-c, 0); returns c.
double egg_centre(Params k) {
  const double less = k[0] - k[1];
  return (k[2] * k[2] - less * less) / (2 * less);
}
double lens_radius(Params k) { return (k[0] * k[0] + k[1] * k[1]) / (2 * k[1]); }

std::vector<Piece> capsule(Params k) {
  const dvec2 n = side_normal(k), top(0, k[2]);
  if (n.y >= 1) return {circle(k[0])};
  if (n.y <= -1) return {arc(top, k[1], 0, 2 * kPi)};
  const double angle = std::atan2(n.y, n.x);
  const Piece side = line(k[0] * n, top + k[1] * n);
  return {side, mirrored(side), arc_below(dvec2(0), k[0], angle), arc(top, k[1], angle, kPi - angle)};
}

std::vector<Piece> straight(dvec2 a, dvec2 b, double t) {
  const dvec2 u = glm::normalize(b - a), n(-u.y, u.x);
  const double angle = std::atan2(n.y, n.x);
  return {line(a + t * n, b + t * n), line(a - t * n, b - t * n), arc(a, t, angle, angle + kPi),
          arc(b, t, angle - kPi, angle)};
}

std::vector<Piece> rounded_rectangle(Params k) {
  const double x = k[0] - k[2], y = k[1] - k[2], r = k[2];
  return with_mirror_images({line({0, k[1]}, {x, k[1]}), line({0, -k[1]}, {x, -k[1]}), line({k[0], -y}, {k[0], y}),
                             arc({x, y}, r, 0, kPi / 2), arc({x, -y}, r, -kPi / 2, 0)});
}

std::vector<Piece> rounded_x(Params k) {
  const double r = k[1], end = k[0] - k[1];
  std::vector<Piece> pieces;
  for (int i = 0; i < 4; ++i) {
    const double angle = kPi / 4 + i * kPi / 2;
    const dvec2 u(std::cos(angle), std::sin(angle)), n(-u.y, u.x), tip = kSqrt2 * end * u;
    pieces.push_back(arc(tip, r, angle - kPi / 2, angle + kPi / 2));
    for (double side : {-1.0, 1.0}) pieces.push_back(line(r * u + side * r * n, tip + side * r * n));
  }
  return pieces;
}

double to_segment(dvec2 p, dvec2 a, dvec2 b) { return distance_to(line(a, b), p); }

bool inside_egg(Params k, dvec2 p) {
  const double c = egg_centre(k), x = std::abs(p.x);
  if (p.y < 0) return glm::length(p) < k[0];
  const bool at_top = c * (p.y - k[2]) > k[2] * x;
  return at_top ? std::hypot(x, p.y - k[2]) < k[1] : std::hypot(x + c, p.y) < c + k[0];
}

bool inside_capsule(Params k, dvec2 p) {
  if (glm::length(p) < k[0] || std::hypot(p.x, p.y - k[2]) < k[1]) return true;
  const dvec2 n = side_normal(k), q(std::abs(p.x), p.y);
  const double along = n.x * q.y - n.y * q.x;
  return glm::dot(q, n) < k[0] && along > 0 && along < k[2] * n.x;
}

bool inside(Kind kind, Params k, dvec2 p) {
  const double x = std::abs(p.x), y = std::abs(p.y), rho = std::hypot(p.x, p.y);
  const double angle = std::atan2(x, p.y);  // from +y
  switch (kind) {
    case Kind::Circle:
      return rho < k[0];
    case Kind::RoundedRectangle:
      return std::hypot(std::max(x - k[0] + k[2], 0.0), std::max(y - k[1] + k[2], 0.0)) < k[2] ||
             (x < k[0] && y < k[1] - k[2]) || (x < k[0] - k[2] && y < k[1]);
    case Kind::Segment:
      return to_segment(p, vec2_at(k, 0), vec2_at(k, 2)) < k[4];
    case Kind::UnevenCapsule:
      return inside_capsule(k, p);
    case Kind::Arc:
      return distance_to(arc_about_y(k[0], radians(k[1])), p) < k[2];
    case Kind::Ring:
      return std::abs(rho - k[0]) < k[2] && (k[1] == 180 || angle < radians(k[1]));
    case Kind::Pie:
      return rho < k[0] && (k[1] == 180 || angle < radians(k[1]));
    case Kind::CutDisk:
      return rho < k[0] && p.y < k[1];
    case Kind::Horseshoe: {
      const double a = radians(k[1]), past = x * std::cos(a) - p.y * std::sin(a);
      const double out = x * std::sin(a) + p.y * std::cos(a);
      if (angle < a) return std::abs(rho - k[0]) < k[3];
      return past < k[2] && std::abs(out - k[0]) < k[3];
    }
    case Kind::VesicaOutline:
      return std::hypot(x + lens_radius(k) - k[1], y) < lens_radius(k);
    case Kind::Moon:
      return rho < k[0] && std::hypot(p.x, p.y - k[2]) > k[1];
    case Kind::Egg:
      return inside_egg(k, p);
    case Kind::Heart:
      if (x + p.y < k[0]) return x < p.y;
      return std::hypot(x - k[0] / 4, p.y - 0.75 * k[0]) < k[0] * kSqrt2 / 4;
    case Kind::RoundedX: {
      const dvec2 end(k[0] - k[1]);
      return to_segment({x, y}, dvec2(0), end) < k[1];
    }
    case Kind::Ellipse:
      return (x / k[0]) * (x / k[0]) + (y / k[1]) * (y / k[1]) < 1;
    default:
      return within_polygon(corners(kind, k), p);
  }
}

// Distance to an ellipse, by bisection. Source: David Eberly, "Distance from a Point to an Ellipse"
// (geometrictools.com).
double to_ellipse(dvec2 radii, dvec2 p) {
  long double a = radii.x, b = radii.y, x = std::abs(p.x), y = std::abs(p.y);
  if (a < b) std::swap(a, b), std::swap(x, y);
  if (y == 0) {
    const long double n = a * x, d = a * a - b * b;
    if (n >= d) return static_cast<double>(std::abs(x - a));
    return static_cast<double>(std::hypot(a * n / d - x, b * std::sqrt(1 - n / d * n / d)));
  }
  const long double r = (a / b) * (a / b), z = x / a, w = y / b;
  long double lo = w - 1, hi = std::hypot(r * z, w) - 1;
  for (int i = 0; i < 400; ++i) {
    const long double s = (lo + hi) / 2;
    const long double g = std::pow(r * z / (s + r), 2.0L) + std::pow(w / (s + 1), 2.0L) - 1;
    (g > 0 ? lo : hi) = s;
  }
  const long double s = (lo + hi) / 2;
  return static_cast<double>(std::hypot(r * x / (s + r) - x, y / (s + 1) - y));
}

}  // namespace

std::vector<Piece> outline_boundary(Kind kind, Params k) {
  const std::vector<dvec2> v = corners(kind, k);
  if (!v.empty()) return closed(v);
  switch (kind) {
    case Kind::Circle:
      return {circle(k[0])};
    case Kind::RoundedRectangle:
      return rounded_rectangle(k);
    case Kind::Segment:
      return straight(vec2_at(k, 0), vec2_at(k, 2), k[4]);
    case Kind::UnevenCapsule:
      return capsule(k);
    case Kind::Arc: {
      if (k[1] == 180) return {circle(k[0] + k[2]), circle(k[0] - k[2])};
      const double a = radians(k[1]);
      const Piece cap = arc(polar(k[0], a), k[2], -kPi / 2 - a, kPi / 2 - a);
      return {arc_about_y(k[0] + k[2], a), arc_about_y(k[0] - k[2], a), cap, mirrored(cap)};
    }
    case Kind::Ring: {
      if (k[1] == 180) return {circle(k[0] + k[2]), circle(k[0] - k[2])};
      const double a = radians(k[1]);
      const Piece end = line(polar(k[0] - k[2], a), polar(k[0] + k[2], a));
      return {arc_about_y(k[0] + k[2], a), arc_about_y(k[0] - k[2], a), end, mirrored(end)};
    }
    case Kind::Pie: {
      if (k[1] == 180) return {circle(k[0])};
      const double a = radians(k[1]);
      const Piece side = line(dvec2(0), polar(k[0], a));
      return {arc_about_y(k[0], a), side, mirrored(side)};
    }
    case Kind::CutDisk: {
      const double half = std::sqrt((k[0] - k[1]) * (k[0] + k[1]));
      return {arc_below(dvec2(0), k[0], std::atan2(k[1], half)), line({-half, k[1]}, {half, k[1]})};
    }
    case Kind::Horseshoe: {
      const double a = radians(k[1]);
      const dvec2 leg(k[2] * std::cos(a), -k[2] * std::sin(a));
      const dvec2 outer = polar(k[0] + k[3], a), inner = polar(k[0] - k[3], a);
      std::vector<Piece> pieces =
          with_mirror_images({line(outer, outer + leg), line(outer + leg, inner + leg), line(inner + leg, inner)});
      pieces.push_back(arc_about_y(k[0] + k[3], a));
      pieces.push_back(arc_about_y(k[0] - k[3], a));
      return pieces;
    }
    case Kind::VesicaOutline: {
      const double r = lens_radius(k), c = r - k[1], a = std::atan2(k[0], c);
      return with_mirror_images({arc({-c, 0}, r, -a, a)});
    }
    case Kind::Moon: {
      const dvec2 at = moon_corner(k);
      return {arc_below(dvec2(0), k[0], std::atan2(at.y, at.x)),
              arc_below({0, k[2]}, k[1], std::atan2(at.y - k[2], at.x))};
    }
    case Kind::Egg: {
      const double c = egg_centre(k), a = std::atan2(k[2], c);
      const Piece side = arc({-c, 0}, c + k[0], 0, a);
      return {arc(dvec2(0), k[0], kPi, 2 * kPi), side, mirrored(side), arc({0, k[2]}, k[1], a, kPi - a)};
    }
    case Kind::Heart: {
      const double s = k[0];
      return with_mirror_images(
          {arc({s / 4, 0.75 * s}, s * kSqrt2 / 4, -kPi / 4, 0.75 * kPi), line(dvec2(0), {s / 2, s / 2})});
    }
    case Kind::RoundedX:
      return rounded_x(k);
    default:
      CHECK(kind == Kind::Ellipse, "an outline");
      return {{false, {}, {}, {}, {k[0], k[1]}, 0, 2 * kPi}};
  }
}

double distance_to(const Piece& piece, dvec2 p) {
  if (piece.straight) {
    const dvec2 ab = piece.b - piece.a;
    const double length2 = glm::dot(ab, ab);
    const double t = length2 > 0 ? std::clamp(glm::dot(p - piece.a, ab) / length2, 0.0, 1.0) : 0.0;
    if (t == 0 || t == 1) return glm::length(p - (t == 0 ? piece.a : piece.b));
    // Between the ends, the distance to the line needs no foot point, which would be rounded.
    return std::abs(ab.x * (p.y - piece.a.y) - ab.y * (p.x - piece.a.x)) / std::sqrt(length2);
  }
  const dvec2 v = p - piece.centre;
  if (piece.radii.x != piece.radii.y) return to_ellipse(piece.radii, v);
  const double radius = piece.radii.x, length = glm::length(v);
  double angle = std::atan2(v.y, v.x);
  while (angle < piece.from) angle += 2 * kPi;
  while (angle > piece.from + 2 * kPi) angle -= 2 * kPi;
  if (length == 0 || angle <= piece.to) return std::abs(length - radius);
  const auto end = [&](double t) { return piece.centre + radius * dvec2(std::cos(t), std::sin(t)); };
  return std::min(glm::length(p - end(piece.from)), glm::length(p - end(piece.to)));
}

double judge_outline(Kind kind, Params k, dvec2 p) {
  // Arcs are judged by their definition. If the round ends overlap, the value inside is only a lower bound.
  if (kind == Kind::Arc) return distance_to(arc_about_y(k[0], radians(k[1])), p) - k[2];
  double nearest = std::numeric_limits<double>::infinity();
  for (const Piece& piece : outline_boundary(kind, k)) nearest = std::min(nearest, distance_to(piece, p));
  return inside(kind, k, p) ? -nearest : nearest;
}

std::optional<Piece> beside_axis(const Piece& edge) {
  constexpr double kOnAxis = 1e-9;  // scene units
  dvec2 a = edge.a, b = edge.b;
  if (a.x > b.x) std::swap(a, b);
  if (b.x <= kOnAxis) return std::nullopt;
  if (a.x < 0) a += (b - a) * (-a.x / (b.x - a.x));
  return line(a, b);
}

double judge_turned_outline(Kind kind, Params k, double offset, dvec2 p) {
  const dvec2 own(p.x - offset, p.y);
  if (kind == Kind::Arc) return judge_outline(kind, k, own);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Piece& piece : outline_boundary(kind, k)) {
    if (!piece.straight) {
      nearest = std::min(nearest, distance_to(piece, own));
    } else if (const auto edge = beside_axis(line(piece.a + dvec2(offset, 0), piece.b + dvec2(offset, 0)))) {
      nearest = std::min(nearest, distance_to(*edge, p));
    }
  }
  return inside(kind, k, own) ? -nearest : nearest;
}

}  // namespace fathom::test
