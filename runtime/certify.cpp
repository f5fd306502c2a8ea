#include "runtime/certify.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

namespace fathom::runtime {
namespace {

constexpr std::uint32_t kCoarsening = 1u << 8;  // evaluations beyond the budget that double the resolution
// Segments shorter than this times max(1, |p|) are not cut further: a thousand times the rounding of double.
constexpr double kResolution = 0x1p-40;
// Intervals cost several evaluations: worth it where so many of the segment's length would be needed to settle it.
constexpr double kRangeRatio = 3;
// ... and where they told something lately: bounds on the slope that are so much tighter, in one of a few tries.
constexpr double kProgress = 0.8;
constexpr int kPatience = 3, kSeldom = 16;

struct Segment {
  double a, ga, b, gb;  // gb: NaN when it is not known yet
  double fall, rise;    // the slope of g is within [-fall, rise]
};

// The part of a segment that g > 0 at its ends does not exclude.
struct Gap {
  double lo, hi;
};

class Search {
 public:
  Search(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, vm::Workspace& workspace)
      : field_(field), origin_(origin), direction_(direction), side_(side), workspace_(workspace) {
    speed_ = field.lipschitz * glm::length(direction);
  }

  Certified run(const Stretch& stretch) {
    Stretch left = stretch;
    double ga = value(left.begin);
    if (side_ == 0) {
      side_ = ga < 0 ? -1 : 1;
      ga = std::abs(ga);
    }
    for (double back = left.hint - left.begin; ga < 0 && back > 0 && left.begin > 0; back *= 2) {
      left.begin = std::max(0.0, left.begin - back);
      ga = value(left.begin);
    }
    if (!std::isfinite(ga)) {
      end(Arrival::Status::Invalid);
    } else if (ga < 0) {
      hit(left.begin, left.begin);
    } else {
      search(left, ga);
    }
    result_.side = side_ < 0 ? -1 : 1;
    return result_;
  }

 private:
  void search(const Stretch& stretch, double ga) {
    push(stretch.begin, ga, stretch.end);
    if (stretch.hint > stretch.begin && stretch.hint < stretch.end) {
      pending_.back().a = stretch.hint;  // its value is that at the near part's end
      push(stretch.begin, ga, stretch.hint);
    }
    while (!pending_.empty() && !done_) settle_next();
    if (!done_) end(contact_ ? Arrival::Status::Contact : Arrival::Status::Miss);
  }

  double value(double t) {
    ++result_.evaluations;
    const double f = field_.evaluate(origin_ + t * direction_, workspace_, result_.instructions);
    return side_ < 0 ? -f : f;
  }

  double scale(double t) const {
    const glm::dvec3 p = glm::abs(origin_ + t * direction_);
    return std::max({1.0, p.x, p.y, p.z});
  }
  double resolution(double t) const {
    const std::uint32_t extra = result_.evaluations - std::min(result_.evaluations, kSearchBudget);
    return std::ldexp(kResolution * scale(t), static_cast<int>(extra / kCoarsening));
  }

  void push(double a, double ga, double b) { pending_.push_back({a, ga, b, std::nan(""), speed_, speed_}); }

  // The nearest segment: free, the root's, or cut in two.
  void settle_next() {
    Segment s = pending_.back();
    pending_.pop_back();
    if (std::isnan(s.gb)) {
      s.gb = value(s.b);
      if (!std::isfinite(s.gb)) return end(Arrival::Status::Invalid);
      if (!pending_.empty() && pending_.back().a == s.b) pending_.back().ga = s.gb;
    }
    Gap gap = gap_of(s);
    if (s.gb >= 0 && gap.lo > gap.hi) return;
    if (gap.hi - gap.lo > (s.b - s.a) / kRangeRatio && worth_narrowing()) {
      if (!narrow(s)) return;
      gap = gap_of(s);
      if (s.gb >= 0 && gap.lo > gap.hi) return;
      if (s.gb < 0 && s.rise <= 0) return find_root(s);
    }
    const double middle = (gap.lo + gap.hi) / 2;
    if (gap.hi - gap.lo <= resolution(middle) || !(middle > s.a && middle < s.b)) {
      if (s.gb < 0) return hit(std::max(s.a, gap.lo), std::min(s.b, gap.hi));
      contact_ = true;
      return;
    }
    const double gm = value(middle);
    if (!std::isfinite(gm)) return end(Arrival::Status::Invalid);
    if (gm >= 0) pending_.push_back({middle, gm, s.b, s.gb, s.fall, s.rise});
    pending_.push_back({s.a, s.ga, middle, gm, s.fall, s.rise});
  }

  // g can be below zero only where neither end's value and slope keep it from it; empty (lo > hi) when that is
  // nowhere.
  static Gap gap_of(const Segment& s) {
    const double infinity = std::numeric_limits<double>::infinity();
    const double lo = s.fall > 0 ? s.a + s.ga / s.fall : infinity;
    if (s.gb < 0) return {std::min(lo, s.b), s.b};
    const double hi = s.rise > 0 ? s.b - s.gb / s.rise : -infinity;
    return {lo, hi};
  }

  // Of iterated maps intervals know nothing until a segment is tiny: where they keep failing they are seldom asked.
  bool worth_narrowing() { return in_vain_ < kPatience || ++skipped_ % kSeldom == 0; }

  // Takes what interval arithmetic knows of the segment; false when it excludes a root.
  bool narrow(Segment& s) {
    ++result_.evaluations;
    const std::optional<vm::AlongLine> known_line =
        field_.along(origin_, direction_, s.a, s.b, workspace_, result_.instructions);
    if (!known_line) return true;
    vm::AlongLine line = *known_line;
    if (side_ < 0) {
      line.value = {-line.value.hi, -line.value.lo};
      line.derivative = {-line.derivative.hi, -line.derivative.lo};
    }
    const double known = s.fall + s.rise;
    s.fall = std::min(s.fall, std::max(0.0, -line.derivative.lo));
    s.rise = std::min(s.rise, std::max(0.0, line.derivative.hi));
    const bool excluded = line.value.lo > 0;
    in_vain_ = excluded || s.fall + s.rise < kProgress * known ? 0 : in_vain_ + 1;
    return !excluded;
  }

  // g falls from above zero at a to zero or below at b: the Illinois method (Dowell and Jarratt, "A Modified Regula
  // Falsi Method", 1971).
  void find_root(const Segment& s) {
    double lo = s.a, hi = s.b, g_lo = s.ga, g_hi = s.gb;
    int kept = 0;  // +1: the last sample replaced lo; -1: hi
    for (int i = 0; i < 200; ++i) {
      const double width = hi - lo, least = 0.25 * kResolution * scale(hi);
      if (width <= 2 * least || g_hi == 0) break;
      const double secant = lo + width * (i % 8 == 7 ? 0.5 : g_lo / (g_lo - g_hi));
      const double t = std::clamp(secant, lo + least, hi - least);
      const double g = value(t);
      if (!std::isfinite(g)) return end(Arrival::Status::Invalid);
      if (g > 0) {
        lo = t, g_lo = g;
        if (kept > 0) g_hi *= 0.5;
        kept = 1;
      } else {
        hi = t, g_hi = g;
        if (kept < 0) g_lo *= 0.5;
        kept = -1;
      }
    }
    hit(g_hi == 0 ? hi : lo, hi);
  }

  void hit(double lo, double hi) {
    result_.t = (lo + hi) / 2;
    result_.width = std::max(hi - lo, 0.0);
    end(Arrival::Status::Hit);
  }
  void end(Arrival::Status status) {
    result_.status = status;
    done_ = true;
  }

  const Field& field_;
  glm::dvec3 origin_, direction_;
  int side_;
  double speed_;  // largest |dg/dt|
  vm::Workspace& workspace_;
  std::vector<Segment> pending_;  // in order along the ray, the nearest last
  bool contact_ = false, done_ = false;
  int in_vain_ = 0, skipped_ = 0;  // intervals that told nothing in a row; those not asked since
  Certified result_{};
};

}  // namespace

Certified certify(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, Stretch stretch,
                  vm::Workspace& workspace) {
  return Search(field, origin, direction, side, workspace).run(stretch);
}

}  // namespace fathom::runtime
