// Intervals of a line inside solids, in closed form and long double: the truth for rays at solids that are cut out of
// each other.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "tests/runtime/rays.h"

namespace fathom::catalogue {

using runtime::Ray;
using runtime::Real;

// Interval of a line, in multiples of the ray's direction. Empty unless begin < end.
struct Span {
  Real begin, end;
  bool empty() const { return !(begin < end); }
  Real length() const { return end - begin; }
};

inline constexpr Span kNowhere{1, -1};
inline constexpr Real kForever = 1e30L;

inline Span sphere_span(const Ray& ray, glm::dvec3 centre, Real radius) {
  Real a = 0, b = 0, c = -radius * radius;
  for (int i = 0; i < 3; ++i) {
    const Real o = static_cast<Real>(ray.origin[i]) - centre[i], d = ray.direction[i];
    a += d * d;
    b += o * d;
    c += o * o;
  }
  const Real discriminant = b * b - a * c;
  if (discriminant < 0) return kNowhere;
  const Real root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

inline Span box_span(const Ray& ray, glm::dvec3 centre, glm::dvec3 half) {
  Span span{-kForever, kForever};
  for (int i = 0; i < 3; ++i) {
    const Real o = static_cast<Real>(ray.origin[i]) - centre[i], d = ray.direction[i], h = half[i];
    if (d == 0) {
      if (std::abs(o) > h) return kNowhere;
      continue;
    }
    span.begin = std::max(span.begin, std::min((-h - o) / d, (h - o) / d));
    span.end = std::min(span.end, std::max((-h - o) / d, (h - o) / d));
  }
  return span;
}

inline Span intersection(Span a, Span b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

// Distance at which a ray from outside enters the solid of `span`; negative for a miss.
inline Real entry(Span span) { return span.empty() || span.begin < 0 ? -1 : span.begin; }

// The smaller of two distances, where a negative distance means a miss.
inline Real nearer(Real a, Real b) { return a < 0 ? b : b < 0 ? a : std::min(a, b); }

// Distance at which a ray from outside enters `whole` minus `cut`; negative for a miss.
inline Real entry_beside(Span whole, Span cut) {
  if (whole.empty()) return -1;
  if (cut.empty() || whole.begin < cut.begin || whole.begin >= cut.end) return entry(whole);
  return cut.end < whole.end ? cut.end : -1;
}

}  // namespace fathom::catalogue
