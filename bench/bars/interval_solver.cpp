#include "bench/bars/interval_solver.h"

#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "bench/interval.h"

namespace fathom::bench {
namespace {

using std::abs, std::max, std::min, std::sqrt;
double square(double a) { return a * a; }
double lower(double a) { return a; }
double upper(double a) { return a; }

// Scene H over any of the number types double, Interval and Jet.
template <class T>
struct Point {
  T x, y, z;
};

template <class T>
T length(const T& x, const T& y) {
  return sqrt(square(x) + square(y));
}
template <class T>
T length(const T& x, const T& y, const T& z) {
  return sqrt(square(x) + square(y) + square(z));
}

template <class T>
T sphere(const Point<T>& p, glm::dvec3 centre, double radius) {
  return length<T>(p.x - T(centre.x), p.y - T(centre.y), p.z - T(centre.z)) - T(radius);
}

template <class T>
T torus(const Point<T>& p, glm::dvec3 centre, double major, double minor) {
  const T ring = length<T>(p.x - T(centre.x), p.z - T(centre.z)) - T(major);
  return length<T>(ring, p.y - T(centre.y)) - T(minor);
}

// length(max(q, 0)) + min(max(q.x, q.y, q.z), 0), one term of which is 0. If at most one component of q can be
// positive, the distance is the largest component. Returning that component keeps the derivative sharp.
template <class T>
T box(const Point<T>& p, glm::dvec3 centre, glm::dvec3 half) {
  const T x = abs(p.x - T(centre.x)) - T(half.x), y = abs(p.y - T(centre.y)) - T(half.y),
          z = abs(p.z - T(centre.z)) - T(half.z);
  const T largest = max(x, max(y, z)), zero(0);
  const int perhaps_positive = (upper(x) > 0) + (upper(y) > 0) + (upper(z) > 0);
  if (perhaps_positive <= 1) return largest;
  const T outside = length<T>(max(x, zero), max(y, zero), max(z, zero));
  if (lower(largest) > 0) return outside;
  return outside + min(largest, zero);
}

template <class T>
T composite(const Point<T>& p) {
  const T ground = p.y + T(1);
  const T ring = torus(p, {-1.6, -0.2, 0}, 0.8, 0.25);
  const T block = box(p, {1.3, -0.4, 0.2}, glm::dvec3(0.6));
  const T ball = sphere(p, {0, 0.3, -1.2}, 0.6);
  const T pebble = sphere(p, {0.2, -0.93, 1.4}, 0.07);
  const T plate = box(p, {0.2, 0, 0.6}, {0.5, 0.7, 0.002});
  return min(min(min(ground, ring), min(block, ball)), min(pebble, plate));
}

Interval along(double origin, double direction, Interval t) { return Interval(origin) + t * Interval(direction); }

struct PrunedProgram {
  double begin, end;
  int sign_at_begin, sign_at_end;  // signs of side * f; 0 when rounding hides the sign
};

struct Sample {
  double t;
  Interval f;  // side * f at t
};

class Search {
 public:
  explicit Search(const Line& line) : line_(line) {}

  Solution run(double t_max) {
    side_ = sign(sample(0).f);
    if (side_ == 0) return {Solution::Status::Undecided};
    parts_.push_back({0, t_max, 1, sign(sample(t_max).f)});
    while (!parts_.empty()) {
      const PrunedProgram part = parts_.back();
      parts_.pop_back();
      if (const auto root = settle(part)) return *root;
    }
    return {open_ ? Solution::Status::Undecided : Solution::Status::Miss};
  }

 private:
  static int sign(Interval f) { return f.lo > 0 ? 1 : f.hi < 0 ? -1 : 0; }

  Sample sample(double t) const {
    const glm::dvec3 &o = line_.origin, &d = line_.direction;
    const Interval f = composite<Interval>({along(o.x, d.x, t), along(o.y, d.y, t), along(o.z, d.z, t)});
    return {t, side_ > 0 ? f : -f};
  }

  // Returns side * f and its derivative over [begin, end].
  Jet over(const PrunedProgram& part) const {
    const Interval t(part.begin, part.end);
    const auto coordinate = [&](int i) {
      return Jet(along(line_.origin[i], line_.direction[i], t), Interval(line_.direction[i]));
    };
    const Jet f = composite<Jet>({coordinate(0), coordinate(1), coordinate(2)});
    return side_ > 0 ? f : -f;
  }

  // Returns the first root of the part when the part can be decided. Otherwise drops the part, leaves it open, or
  // splits it in two.
  std::optional<Solution> settle(const PrunedProgram& part) {
    const Jet f = over(part);
    const bool changes = part.sign_at_begin > 0 && part.sign_at_end < 0;
    if (f.v.lo > 0) return std::nullopt;
    if (changes && f.d.hi <= 0) return bisect(part);
    const bool monotone = f.d.hi <= 0 || f.d.lo >= 0;
    if (monotone && part.sign_at_begin > 0 && part.sign_at_end > 0) return std::nullopt;
    const auto [middle, at_middle] = split(part);
    if (part.end - part.begin <= kFinest * max(1.0, part.end) || !(middle > part.begin && middle < part.end)) {
      if (changes && !open_) return Solution{Solution::Status::Hit, middle};
      open_ = true;
      // Everything beyond a change of sign is behind the surface.
      return changes ? std::optional(Solution{Solution::Status::Undecided}) : std::nullopt;
    }
    const Interval centred = at_middle + f.d * (Interval(part.begin, part.end) - Interval(middle));
    if (centred.lo > 0) return std::nullopt;
    const int s = sign(at_middle);
    if (s >= 0) parts_.push_back({middle, part.end, s, part.sign_at_end});
    parts_.push_back({part.begin, middle, part.sign_at_begin, s});
    return std::nullopt;
  }

  // Returns a sample near the middle at which the sign can be decided.
  Sample split(const PrunedProgram& part) const {
    for (const double share : {0.5, 0.4375, 0.5625}) {
      const Sample s = sample(part.begin + share * (part.end - part.begin));
      if (sign(s.f) != 0) return s;
    }
    return sample(part.begin + 0.5 * (part.end - part.begin));
  }

  std::optional<Solution> bisect(PrunedProgram part) const {
    while (part.end - part.begin > kFinest) {
      const double middle = part.begin + (part.end - part.begin) / 2;
      const int s = sign(sample(middle).f);
      if (s == 0 || !(middle > part.begin && middle < part.end)) break;
      (s > 0 ? part.begin : part.end) = middle;
    }
    // An earlier part that stayed open may also hold a root.
    if (open_) return Solution{Solution::Status::Undecided};
    return Solution{Solution::Status::Hit, part.begin + (part.end - part.begin) / 2};
  }

  const Line& line_;
  int side_ = 1;
  std::vector<PrunedProgram> parts_;  // in order along the ray, the nearest last
  bool open_ = false;
};

}  // namespace

Solution solve_composite(const Line& line, double t_max) { return Search(line).run(t_max); }

double composite_distance(glm::dvec3 p) { return composite<double>({p.x, p.y, p.z}); }

glm::dvec3 composite_normal(glm::dvec3 p) {
  glm::dvec3 gradient(0);
  for (int i = 0; i < 3; ++i) {
    const auto coordinate = [&](int k) { return Jet(Interval(p[k]), Interval(k == i ? 1 : 0)); };
    gradient[i] = composite<Jet>({coordinate(0), coordinate(1), coordinate(2)}).d.middle();
  }
  return glm::normalize(gradient);
}

}  // namespace fathom::bench
