#include "tests/support/judge/judge_domain.h"
#include "tests/support/judge/judge_geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace fathom::test {
namespace {

using compiler::Kind;
using glm::dvec3;

constexpr double kRadians = std::numbers::pi / 180;


dvec3 turned_about_y(dvec3 p, double angle) {
  return {p.x * std::cos(angle) + p.z * std::sin(angle), p.y, p.z * std::cos(angle) - p.x * std::sin(angle)};
}

// Nearest point of a tube of radius r about the y axis.
dvec3 into_tube(dvec3 p, double r) {
  const double rho = std::hypot(p.x, p.z);
  return rho > r ? dvec3(p.x / rho * r, p.y, p.z / rho * r) : p;
}

// Signed distance from a to the interval [lo, hi]; 0 inside.
double outside(double a, double lo, double hi) { return a - std::clamp(a, lo, hi); }

// Distance to the intersection of two bodies whose surfaces are orthogonal, given the distances to each.
double met(double a, double b) {
  if (a <= 0 || b <= 0) return std::max(a, b);
  return std::hypot(a, b);
}

// Signed distance to a box, exact inside and outside.
double box_distance(dvec3 p, dvec3 lo, dvec3 hi) {
  const dvec3 beyond = glm::max(lo - p, p - hi);
  const double inside = std::max({beyond.x, beyond.y, beyond.z});
  return inside <= 0 ? inside : glm::length(glm::max(beyond, dvec3(0)));
}

// One of 289 shifts per cell: the permutation n -> n (34 n + 1) mod 289 in integer arithmetic.
long permuted(long n) {
  const long m = ((n % 289) + 289) % 289;
  return m * (34 * m + 1) % 289;
}
dvec3 shift(long i, long j, long l) {
  const long x = permuted(permuted(permuted(i) + j) + l), y = permuted(x + 1), z = permuted(y + 1);
  return {x / 144.0 - 1, y / 144.0 - 1, z / 144.0 - 1};
}

// Parameters of a repetition: period, count, jitter. Derived: copies to either side, margin (`apart`), reach, the
// child's box.
struct Axis {
  double period, count;
  bool repeated() const { return period > 0; }
  double half() const { return count > 0 && std::fmod(count, 2) == 0 ? 0.5 : 0; }
  long first() const { return count > 0 ? -static_cast<long>(count) / 2 : -8388608; }
  long last() const { return count > 0 ? first() + static_cast<long>(count) - 1 : 8388607; }
  double middle(long number) const { return (static_cast<double>(number) + half()) * period; }
  // Returns the number of the copy whose centre is nearest.
  long nearest(double a) const {
    const auto number = static_cast<long>(std::llround(a / period - half()));
    return std::clamp(number, first(), last());
  }
};
Axis axis_of(Params k, std::size_t i) { return {k[i], k[3 + i]}; }

std::vector<long> numbers(Params k, std::size_t i, double a) {
  const Axis axis = axis_of(k, i);
  if (!axis.repeated()) return {0};
  // The judge visits all copies where the machine evaluates all, else one more to either side than the machine does.
  const bool all = k[9 + i] < 0;
  const long at = axis.nearest(a), around = all ? static_cast<long>(axis.count) : 1 + static_cast<long>(k[9 + i]);
  std::vector<long> result;
  for (long n = std::max(axis.first(), at - around); n <= std::min(axis.last(), at + around); ++n)
    result.push_back(n);
  return result;
}

std::vector<dvec3> repeated(Params k, dvec3 p) {
  std::vector<dvec3> points;
  for (long x : numbers(k, 0, p.x)) {
    for (long y : numbers(k, 1, p.y)) {
      for (long z : numbers(k, 2, p.z)) {
        const dvec3 cell(axis_of(k, 0).middle(x), axis_of(k, 1).middle(y), axis_of(k, 2).middle(z));
        points.push_back(p - cell - shift(x, y, z) * vec3_at(k, 6));
      }
    }
  }
  return points;
}

// Lower bound on the distance to the omitted copies, along each axis that has omitted copies.
double repetition_limit(Params k, dvec3 p) {
  dvec3 out(0);
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Axis axis = axis_of(k, n);
    if (axis.repeated() && axis.count == 0) continue;
    const double lo = axis.repeated() ? axis.middle(axis.first()) : 0,
                 hi = axis.repeated() ? axis.middle(axis.last()) : 0;
    out[i] = outside(p[i], lo + k[16 + n] - k[6 + n], hi + k[19 + n] + k[6 + n]);
  }
  double limit = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Axis axis = axis_of(k, n);
    if (!axis.repeated() || k[9 + n] <= 0) continue;
    dvec3 way = out;
    way[i] = std::abs(p[i] - axis.middle(axis.nearest(p[i]))) + k[12 + n];
    limit = std::min(limit, glm::length(way));
  }
  return limit * k[15];
}

// Parameters: count. Derived: sides, middle, apart, reach, y range, max and min distance from the axis. The judge
// evaluates all copies.
std::vector<dvec3> around(Params k, dvec3 p) {
  std::vector<dvec3> points;
  for (int i = 0; i < static_cast<int>(k[0]); ++i) {
    points.push_back(turned_about_y(p, 2 * std::numbers::pi * i / k[0]));
  }
  return points;
}
double polar_value(Params k, dvec3 p, double child) {
  if (k[1] < 0) return child;
  const double sector = 2 * std::numbers::pi / k[0];
  const double aside = std::abs(std::remainder(std::atan2(p.z, p.x) - k[2], sector)) + k[3];
  const double rho = std::hypot(p.x, p.z);
  const double across = std::max(k[8] - rho, rho * (aside < std::numbers::pi / 2 ? std::sin(aside) : 1));
  const double limit = k[4] * std::hypot(across, outside(p.y, k[5], k[6]));
  return std::max(std::min(child, limit), box_distance(p, {-k[7], k[5], -k[7]}, {k[7], k[6], k[7]}));
}

// Parameters: turn. Derived: radius, side, inner radius, Lipschitz constant, ... (compiler/shapes/domain.cpp).
dvec3 bent(Params k, dvec3 p) {
  const double up = p.y * k[2], rho = std::max(k[3], std::hypot(p.x, k[1] - up));
  return {k[1] * std::atan2(p.x, k[1] - up), k[2] * (k[1] - rho), p.z};
}
double bent_value(Params k, dvec3 p, double child) {
  const double down = k[1] - p.y * k[2], rho = std::hypot(p.x, down);
  const double to_middle = std::max(0.0, rho - k[3]) + k[5];
  const double to_seam = (down < 0 ? std::abs(p.x) : rho) + k[6];
  const double limit = std::hypot(std::min(to_middle, to_seam), outside(p.z, k[7], k[8]) * k[9]);
  const dvec3 lo(k[10], k[11], k[7]), hi(k[12], k[13], k[8]);
  return std::max(std::min(child, limit), box_distance(p, lo, hi));
}

double taper_scale(Params k, double y) {
  const double t = std::clamp((y + k[2]) / (2 * k[2]), 0.0, 1.0);
  return (1 - t) * k[0] + t * k[1];
}

double tube_met(double child, dvec3 p, double radius, double lipschitz) {
  return met(child, lipschitz * (std::hypot(p.x, p.z) - radius));
}

// In the middle block of a body elongated along all axes, the distance to the block's faces is added to the depth.
double pulled_apart(Params k, dvec3 p, double child) {
  const bool all = k[0] > 0 && k[1] > 0 && k[2] > 0;
  if (!all || child >= 0) return child;
  return child + std::min(0.0, std::max({std::abs(p.x) - k[0], std::abs(p.y) - k[1], std::abs(p.z) - k[2]}));
}

double box_met(Params k, dvec3 p, double child) { return met(child, k[6] * box_distance(p, vec3_at(k, 0), vec3_at(k, 3))); }

}  // namespace

std::vector<dvec3> child_points(Kind kind, Params k, dvec3 p) {
  switch (kind) {
    case Kind::Transform:  // the row-major 3x4 matrix maps p to the child's space
      return {{glm::dot(vec3_at(k, 0), p) + k[3], glm::dot(vec3_at(k, 4), p) + k[7], glm::dot(vec3_at(k, 8), p) + k[11]}};
    case Kind::Elongate:
      return {{outside(p.x, -k[0], k[0]), outside(p.y, -k[1], k[1]), outside(p.z, -k[2], k[2])}};
    case Kind::Revolve:
      return {{std::hypot(p.x, p.z) - k[0], p.y, 0}};
    case Kind::Mirror: {
      const dvec3 n = glm::normalize(vec3_at(k, 0));
      const double above = glm::dot(n, p) - k[3];
      return {above < 0 ? p - 2 * above * n : p};
    }
    case Kind::Repetition:
      return repeated(k, p);
    case Kind::PolarRepetition:
      return around(k, p);
    case Kind::Twist: {
      const dvec3 q = into_tube(p, k[1]);
      return {turned_about_y(q, -k[0] * kRadians * q.y)};
    }
    case Kind::Bend:
      return {bent(k, p)};
    case Kind::Taper: {
      const dvec3 q = into_tube(p, k[3]);
      const double s = taper_scale(k, q.y);
      return {{q.x / s, q.y, q.z / s}};
    }
    case Kind::Bounded:
      return {glm::clamp(p, vec3_at(k, 0), vec3_at(k, 3))};
    default:
      return {p};
  }
}

double altered(Kind kind, Params k, dvec3 p, double child) {
  switch (kind) {
    case Kind::Transform:
      return child * k[12];
    case Kind::Scaled:
      return child * k[0];
    case Kind::Round:
      return child - k[0];
    case Kind::Onion:
      return std::abs(child) - k[0];
    case Kind::Complement:
      return -child;
    case Kind::Elongate:
      return pulled_apart(k, p, child);
    case Kind::Extrude:
      return met(child, std::abs(p.z) - k[0]);
    case Kind::Repetition:
      return std::min(child, repetition_limit(k, p));
    case Kind::PolarRepetition:
      return polar_value(k, p, child);
    case Kind::Twist:
      return tube_met(child, p, k[1], k[2]);
    case Kind::Taper:
      return tube_met(child, p, k[3], k[4]);
    case Kind::Bend:
      return bent_value(k, p, child);
    case Kind::Bounded:
      return box_met(k, p, child);
    default:
      return child;
  }
}

}  // namespace fathom::test
