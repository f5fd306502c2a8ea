#include "runtime/march/certified_search.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

namespace fathom::runtime {
namespace {

constexpr std::uint32_t kCoarsening = 1u << 8;  // evaluations beyond the budget per doubling of the resolution
// Maximum of the coarsened resolution, relative to max(1, |p|) or to the interval, so that the search does not pass
// over surfaces that follow a point that is hard to search.
constexpr double kCoarsest = 0x1p-10;
// Segments shorter than this, relative to max(1, |p|), are not cut further: a thousand times the rounding of double.
constexpr double kResolution = 0x1p-40;
// Length, relative to max(1, |p|), that may stay open before the end of a segment that ends behind the surface: the
// reported root may not be the first, but is no further from the first than this. A 256th of the relative width of
// brackets in float (stream.cpp).
constexpr double kRootResolution = 0x1p-30;
// Minimum length of a segment worth intervals, relative to the part that its near end excludes, because intervals
// cost many evaluations. kCostlyRangeRatio applies where Field::max_informative_length is finite, because
// intervals of iterated maps cost a hundred evaluations, and to fields with `cells`, which know slopes without
// intervals.
constexpr double kRangeRatio = 8, kCostlyRangeRatio = 64;
// An interval is informative if it narrows the bounds on the slope to this share.
constexpr double kProgress = 0.8;
// After an uninformative interval, the search next tries a segment kShorter times shorter. The search tries longer
// segments only after kRetryPeriod evaluations, and then after twice as many.
constexpr double kShorter = 8;
constexpr std::uint32_t kRetryPeriod = 1u << 10;
// In a large scene intervals need the whole program, but an evaluation only a small part of it. Intervals are tried
// after this many evaluations, or after a kIntervalPeriodShare-th of the program's instructions if that is more, and
// after the same number again.
constexpr std::uint32_t kMinIntervalPeriod = 16, kIntervalPeriodShare = 4;
// kReach: length of a step, relative to the length at which the balls of both ends just touch. kLargestSlope: maximum
// slope expected, relative to its bound (compare tiered-inl.h).
constexpr double kReach = 0.995, kLargestSlope = 0.9;
// Near a root, a step has this length relative to the way to the root.
constexpr double kOvershoot = 1.1;
constexpr int kMaxRounds = 200;  // per bracket

}  // namespace

CertifiedSearch::CertifiedSearch(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side,
                                 const RayInterval& interval)
    : field_(&field),
      origin_(origin),
      direction_(direction),
      side_(side),
      speed_(glm::length(direction)),
      max_slope_(field.lipschitz * speed_),
      interval_(interval),
      backtrack_(interval.hint - interval.begin),
      done_(false),
      range_ratio_(std::isfinite(field.max_informative_length) || field.cells ? kCostlyRangeRatio : kRangeRatio),
      max_informative_(field.max_informative_length / speed_),
      interval_period_(field.far_levels.used() && !field.cells
                           ? std::max(kMinIntervalPeriod, field.distance->instructions() / kIntervalPeriodShare)
                           : 0),
      next_interval_at_(interval_period_ > 0 ? interval_period_ : kRetryPeriod) {
  request(interval.begin, Purpose::Begin);
}

void CertifiedSearch::request(double t, Purpose purpose) {
  requested_t_ = t;
  purpose_ = purpose;
}

void CertifiedSearch::supply(double f, std::uint64_t instructions, RealScratch& scratch) {
  ++result_.evaluations;
  result_.instructions += instructions;
  rounding_ = field_->rounding(point());
  if (side_ == 0) side_ = f < -rounding_ ? -1 : 1;
  if (!std::isfinite(f)) {
    if (purpose_ == Purpose::Begin) return end(RayHit::Status::Invalid);
    undefined_from_ = std::min(undefined_from_, requested_t_);
  }
  // Raises g by the rounding error, so that g is nowhere below 0 where the field is 0. A place without a value counts
  // as solid, so that a surface before it is found: hit() tells it from a surface.
  const double g = std::isfinite(f) ? (side_ < 0 ? -f : f) + rounding_ : -1;
  const bool has_radius = field_->cells && purpose_ != Purpose::Root && g > rounding_;
  radius_ = has_radius ? field_->cells->radius(std::abs(f), point()) / speed_ : 0;
  switch (purpose_) {
    case Purpose::Begin:
      return begin(g);
    case Purpose::End:
      current_.gb = g, current_.rb = radius_;
      if (!pending_.empty() && pending_.back().a == current_.b) pending_.back().ga = g, pending_.back().ra = radius_;
      return advance(scratch);
    case Purpose::Split:
      if (split(g)) advance(scratch);
      return;
    case Purpose::Root:
      return narrow_bracket(g - root_level_);
  }
}

// Begins the search where g >= 0. Otherwise moves `begin` back if there is a hint, or reports a hit there.
void CertifiedSearch::begin(double g) {
  double& from = interval_.begin;
  if (g < 0 && backtrack_ > 0 && from > 0) {
    from = std::max(0.0, from - backtrack_);
    backtrack_ *= 2;
    return request(from, Purpose::Begin);
  }
  if (g < 0) return hit(from, from);
  current_ = {from, g, interval_.end, 0, max_slope_, max_slope_, radius_};
  if (interval_.hint > from && interval_.hint < interval_.end) {
    current_.b = interval_.hint;
    // The far part's value at the hint is set with the near part's end, in supply().
    pending_.push_back({current_.b, g, interval_.end, std::nan(""), max_slope_, max_slope_});
  }
  request(current_.b, Purpose::End);
}

// Continues with the near part of the segment that was cut. A near part that is free is left behind, and the search
// continues with the far part, which then is not stored. False if the search is done or looks for a root.
bool CertifiedSearch::split(double g) {
  const Segment nearer{current_.a, current_.ga, requested_t_, g, current_.fall, current_.rise, current_.ra, radius_};
  if (is_free(nearer, gap_of(nearer)) && !may_hide_end(nearer)) {
    current_.a = requested_t_, current_.ga = g, current_.ra = radius_;
    return pass_segment(nearer);
  }
  if (g >= 0) {
    pending_.push_back(
        {requested_t_, g, current_.b, current_.gb, current_.fall, current_.rise, radius_, current_.rb});
  }
  current_ = nearer;
  return true;
}

// Settles the nearest segment, again and again, until a value is needed.
void CertifiedSearch::advance(RealScratch& scratch) {
  while (process_segment(scratch)) {
    if (pending_.empty()) return end(near_miss_ ? RayHit::Status::NearMiss : RayHit::Status::Miss);
    current_ = pending_.back();
    pending_.pop_back();
    if (std::isnan(current_.gb)) return request(current_.b, Purpose::End);
  }
}

// True if the segment is finished: free, or too short to decide. Otherwise the segment holds a root or is cut in two,
// and the search needs a value.
bool CertifiedSearch::process_segment(RealScratch& scratch) {
  Segment& s = current_;
  Gap gap = gap_of(s);
  bool free = is_free(s, gap);
  IntervalOutcome outcome = IntervalOutcome::Nothing;
  if (!free && worth_narrowing(s, gap)) {
    outcome = narrow(s, scratch);
    gap = gap_of(s);
    free = outcome == IntervalOutcome::Free || is_free(s, gap);
    if (!free && outcome == IntervalOutcome::Slope && s.gb < 0 && s.rise <= 0) {
      find_root(s, 0);
      return false;
    }
  }
  if (free && may_hide_end(s)) {
    request((s.a + s.b) / 2, Purpose::Split);
    return false;
  }
  if (free) return pass_segment(s);
  const double open = gap.hi - gap.lo, middle = (gap.lo + gap.hi) / 2;
  // Without a bound on the slope, e.g. next to a jump, intervals know nothing of a short segment either.
  const bool fine = s.gb >= 0 && std::isfinite(s.fall);
  if (open <= coarsened(fine ? kResolution : kRootResolution, middle) || !(middle > s.a && middle < s.b)) {
    if (s.gb < 0) {
      find_root(s, std::min(s.b, gap.hi) - std::max(s.a, gap.lo));
      return false;
    }
    near_miss_ = true;
    // Beyond a segment without informative intervals, e.g. where a field comes down to a plateau, intervals may be
    // tried on longer segments again.
    max_informative_ = std::max(max_informative_, kShorter * (s.b - s.a));
    return side_ > 0 || !ends_solid(s, true);
  }
  request(outcome == IntervalOutcome::Slope ? middle : std::min(middle, split_point(s, gap)), Purpose::Split);
  return false;
}

// Goes on beyond a segment that is free. False if the solid turns out to have ended before.
bool CertifiedSearch::pass_segment(const Segment& s) {
  slope_ = (s.gb - s.ga) / (s.b - s.a);
  return side_ > 0 || !ends_solid(s, is_flat(s));
}

// True if all of a segment is at the rounding level of 0, given that its ends are.
bool CertifiedSearch::is_flat(const Segment& s) const {
  return std::min(s.fall, s.rise) * (s.b - s.a) <= kLevelRoundings * rounding_;
}

// True if a free segment of a solid may be at the rounding level of 0 for long, next to an end at that level.
bool CertifiedSearch::may_hide_end(const Segment& s) const {
  const double level = kLevelRoundings * rounding_;
  if (side_ > 0 || (s.ga > level && s.gb > level) || s.b - s.a <= kMinLevel * scale(s.a)) return false;
  return s.ga > level || s.gb > level || !is_flat(s);
}

// True if a solid has ended by the end of the segment. `flat`: g rises nowhere far within the segment.
bool CertifiedSearch::ends_solid(const Segment& s, bool flat) {
  const double level = kLevelRoundings * rounding_;
  if (s.gb > level) {
    above_ = s.b, g_above_ = s.gb;
  } else if (s.ga > level) {
    above_ = s.a, g_above_ = s.ga;
  } else if (flat) {
    if (std::isnan(level_begin_)) level_begin_ = s.a, g_level_ = s.ga;
    if (s.b - level_begin_ <= kMinLevel * scale(level_begin_)) return false;
    leave_solid(level);
    return true;
  }
  level_begin_ = std::nan("");
  return false;
}

// Ends a solid where g came down to the rounding level at which it has stayed since.
void CertifiedSearch::leave_solid(double level) {
  if (g_above_ == 0) return hit(level_begin_, level_begin_);
  root_level_ = 2 * level;
  find_root({above_, g_above_ - root_level_, level_begin_, g_level_ - root_level_, 0, 0}, 0);
}

// Returns the t at which to cut: so near that intervals may be informative for the near part, otherwise where the
// balls of the near end and of the new sample should just touch if g keeps its slope, or just beyond a root that is
// near.
double CertifiedSearch::split_point(const Segment& s, const Gap& gap) const {
  // The slopes that the near end's ball allows for.
  const double local = s.ra > 0 ? s.ga / s.ra : std::numeric_limits<double>::infinity();
  const double fall = std::min(s.fall, local), rise = std::min(s.rise, local);
  const double near = gap.lo - s.a, slope = std::clamp(slope_, -fall, kLargestSlope * rise);
  const double least = gap.lo + coarsened(kResolution, gap.lo);
  if (max_informative_ > range_ratio_ * near) return std::max(s.a + max_informative_, least);
  double step = kReach * (near + s.ga / rise) / (1 - slope / rise);
  if (slope < 0) {
    const double open = 0.75 * coarsened(kRootResolution, gap.lo);
    step = std::max(step, std::min(kOvershoot * s.ga / -slope, near + open));
  }
  return std::max(s.a + step, least);
}

bool CertifiedSearch::is_free(const Segment& s, const Gap& gap) { return s.gb >= 0 && gap.lo > gap.hi; }

// Returns the part in which neither end's value and slope exclude g < 0. The gap is empty (lo > hi) if there is none.
CertifiedSearch::Gap CertifiedSearch::gap_of(const Segment& s) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double lo = s.fall > 0 ? s.a + std::max(s.ga / s.fall, s.ra) : infinity;
  if (s.gb < 0) return {std::min(lo, s.b), s.b};
  const double hi = s.rise > 0 ? s.b - std::max(s.gb / s.rise, s.rb) : -infinity;
  return {lo, hi};
}

bool CertifiedSearch::worth_narrowing(const Segment& s, const Gap& gap) {
  const double length = s.b - s.a;
  if (length <= range_ratio_ * (gap.lo - s.a)) return false;
  if (length <= max_informative_ && interval_period_ == 0) return true;
  if (result_.evaluations < next_interval_at_) return false;
  next_interval_at_ = interval_period_ > 0 ? result_.evaluations + interval_period_ : 2 * next_interval_at_;
  return true;
}

// Narrows the segment's bounds by interval arithmetic.
CertifiedSearch::IntervalOutcome CertifiedSearch::narrow(Segment& s, RealScratch& scratch) {
  ++result_.evaluations;
  const double length = s.b - s.a, known = s.fall + s.rise;
  std::optional<vm::AlongLine> line = field_->along(origin_, direction_, s.a, s.b, scratch, result_.instructions);
  bool free = false;
  if (line) {
    const auto [lo, hi] = line->derivative;
    s.fall = std::min(s.fall, std::max(0.0, side_ < 0 ? hi : -lo));
    s.rise = std::min(s.rise, std::max(0.0, side_ < 0 ? -lo : hi));
    // The value's bounds reveal a plateau at 0 even where the derivative's bounds are those of its surroundings.
    // Outside a solid the plateau is free. Inside a solid, the solid ends there. No point has a smaller rounding
    // error than the origin.
    const double flat = field_->rounding({});
    const bool empty = line->value.lo >= -flat;
    if (side_ > 0) {
      free = empty;
    } else if (empty && (s.gb >= 0 || length > kMinLevel * scale(s.a))) {
      free = true;
      s.fall = s.rise = 0;
    } else {
      free = line->value.hi < 0;
    }
  }
  // Intervals leave out places without a value.
  free = free && s.b < undefined_from_;
  const bool outcome = free || s.fall + s.rise < kProgress * known;
  max_informative_ = outcome ? std::max(max_informative_, kShorter * length) : length / kShorter;
  return free ? IntervalOutcome::Free : outcome ? IntervalOutcome::Slope : IntervalOutcome::Nothing;
}

// Narrows the root of a segment over which g falls from above zero to zero or below. The first root is in an interval
// of that width. By the Illinois method (Dowell and Jarratt, "A Modified Regula Falsi Method", 1971).
void CertifiedSearch::find_root(const Segment& s, double width) {
  bracket_ = {s.a, s.b, s.ga, s.gb, 0, 0};
  width_ = width;
  continue_bracket();
}

void CertifiedSearch::continue_bracket() {
  const Bracket& b = bracket_;
  const double width = b.hi - b.lo, least = 0.25 * kResolution * scale(b.hi);
  if (width <= 2 * least || b.g_hi == 0 || b.rounds == kMaxRounds) return hit(b.g_hi == 0 ? b.hi : b.lo, b.hi);
  const double secant = b.lo + width * (b.rounds % 8 == 7 ? 0.5 : b.g_lo / (b.g_lo - b.g_hi));
  request(std::clamp(secant, b.lo + least, b.hi - least), Purpose::Root);
}

void CertifiedSearch::narrow_bracket(double g) {
  Bracket& b = bracket_;
  if (g > 0) {
    b.lo = requested_t_, b.g_lo = g;
    if (b.kept > 0) b.g_hi *= 0.5;
    b.kept = 1;
  } else {
    b.hi = requested_t_, b.g_hi = g;
    if (b.kept < 0) b.g_lo *= 0.5;
    b.kept = -1;
  }
  ++b.rounds;
  continue_bracket();
}

double CertifiedSearch::scale(double t) const {
  const glm::dvec3 p = glm::abs(origin_ + t * direction_);
  return std::max({1.0, p.x, p.y, p.z});
}
double CertifiedSearch::coarsened(double resolution, double t) const {
  const double finest = resolution * scale(t);
  if (result_.evaluations <= kSearchBudget) return finest;
  const double coarser = std::ldexp(finest, static_cast<int>((result_.evaluations - kSearchBudget) / kCoarsening));
  return std::min(coarser, std::max(finest, kCoarsest * std::min(scale(t), interval_.end - interval_.begin)));
}

void CertifiedSearch::hit(double lo, double hi) {
  if (hi >= undefined_from_) {
    requested_t_ = undefined_from_;  // for point()
    return end(RayHit::Status::Invalid);
  }
  result_.t = (lo + hi) / 2;
  result_.width = std::max({hi - lo, width_, 0.0});
  end(RayHit::Status::Hit);
}

void CertifiedSearch::end(RayHit::Status status) {
  result_.status = status;
  result_.side = side_ < 0 ? -1 : 1;
  done_ = true;
}

}  // namespace fathom::runtime
