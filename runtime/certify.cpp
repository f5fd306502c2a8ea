#include "runtime/certify.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

namespace fathom::runtime {
namespace {

constexpr std::uint32_t kBudget = 1u << 20;          // evaluations
constexpr std::uint32_t kEstimateBudget = 1u << 14;  // the same where L is an estimate and may never certify
// Segments shorter than this times max(1, |p|) are not cut further: the resolution of float32 coordinates.
constexpr double kResolution = 0x1p-23;
constexpr int kNarrowings = 8;  // evaluations at most to narrow a hit's bracket
// Intervals cost several evaluations: worth it where bisection would need many.
constexpr double kRangeRatio = 4;

struct Segment {
  double a, ga, b, gb;
};

class Search {
 public:
  Search(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, vm::Workspace& workspace)
      : field_(field), origin_(origin), direction_(direction), side_(side), workspace_(workspace) {
    speed_ = field.lipschitz * glm::length(direction);
  }

  Certified run(double begin, double end) {
    const double ga = value(begin), gb = value(end);
    if (!std::isfinite(ga) || !std::isfinite(gb)) return finish(Certified::Outcome::NotFinite);
    if (ga <= 0) return hit(begin, begin);
    pending_.push_back({begin, ga, end, gb});
    const std::uint32_t budget = field_.certified ? kBudget : kEstimateBudget;
    while (!pending_.empty()) {
      const Segment s = pending_.back();
      pending_.pop_back();
      if (s.gb > 0 && is_free(s)) continue;
      // Only this part of the segment lies in neither end's ball.
      const double lo = s.a + s.ga / speed_, hi = s.b - std::abs(s.gb) / speed_;
      const double middle = (lo + hi) / 2;
      if (hi - lo <= resolution(middle) || !(middle > s.a && middle < s.b)) {
        if (s.gb <= 0) return narrow(s, std::max(s.a, lo), std::min(s.b, hi));
        result_.contact = true;
        continue;
      }
      if (result_.evaluations >= budget) return finish(Certified::Outcome::Exhausted);
      const double gm = value(middle);
      if (!std::isfinite(gm)) return finish(Certified::Outcome::NotFinite);
      if (gm > 0) pending_.push_back({middle, gm, s.b, s.gb});
      pending_.push_back({s.a, s.ga, middle, gm});
    }
    return finish(Certified::Outcome::Miss);
  }

 private:
  double value(double t) {
    ++result_.evaluations;
    return side_ * vm::evaluate_distance(*field_.distance, origin_ + t * direction_, workspace_);
  }

  double resolution(double t) const {
    const glm::dvec3 p = glm::abs(origin_ + t * direction_);
    return kResolution * std::max({1.0, p.x, p.y, p.z});
  }

  bool is_free(const Segment& s) {
    const double known = s.ga + s.gb, needed = speed_ * (s.b - s.a);
    if (known > needed) return true;
    if (kRangeRatio * known > needed) return false;
    ++result_.evaluations;
    // Grown by far more than the rounding of the end points.
    const glm::dvec3 a = origin_ + s.a * direction_, b = origin_ + s.b * direction_;
    const glm::dvec3 margin = 0x1p-48 * (glm::abs(a) + glm::abs(b));
    const vm::Range range =
        vm::evaluate_range(*field_.distance, glm::min(a, b) - margin, glm::max(a, b) + margin, workspace_);
    return side_ > 0 ? range.lo > 0 : range.hi < 0;
  }

  // The hit of a segment that is not cut further, between `lo` and `hi`. What is seen from nearer than that
  // resolution is found by the Illinois method, as in march_lane.cpp.
  Certified narrow(Segment s, double lo, double hi) {
    double weight_a = s.ga, weight_b = s.gb;
    for (int i = 0; i < kNarrowings && hi - lo > field_.finest; ++i) {
      const double t = s.a + weight_a / (weight_a - weight_b) * (s.b - s.a);
      if (!(t > s.a && t < s.b)) break;
      const double g = value(t);
      if (!std::isfinite(g)) return finish(Certified::Outcome::NotFinite);
      if (g == 0) return hit(t, t);
      if (g > 0) {
        s.a = t, weight_a = g, weight_b /= 2;
        lo = std::min(t + g / speed_, hi);
      } else {
        s.b = t, weight_b = g, weight_a /= 2;
        hi = std::max(t + g / speed_, lo);
      }
    }
    return hit(lo, hi);
  }

  Certified hit(double lo, double hi) {
    result_.t = (lo + hi) / 2;
    result_.width = std::max(hi - lo, 0.0);
    return finish(Certified::Outcome::Hit);
  }
  Certified finish(Certified::Outcome outcome) {
    result_.outcome = outcome;
    result_.contact &= outcome == Certified::Outcome::Miss;
    return result_;
  }

  const Field& field_;
  glm::dvec3 origin_, direction_;
  double side_;
  double speed_;  // largest |dg/dt|
  vm::Workspace& workspace_;
  std::vector<Segment> pending_;  // in order along the ray, the nearest last
  Certified result_{};
};

}  // namespace

Certified certify(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, double begin, double end,
                  vm::Workspace& workspace) {
  return Search(field, origin, direction, side, workspace).run(begin, end);
}

}  // namespace fathom::runtime
