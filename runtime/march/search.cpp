#include "runtime/march/search.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

namespace fathom::runtime {
namespace {

constexpr std::uint32_t kCoarsening = 1u << 8;  // evaluations beyond the budget that double the resolution
// ... up to this times max(1, |p|) or the stretch: what follows a place that is hard to search is not passed over.
constexpr double kCoarsest = 0x1p-10;
// Segments shorter than this times max(1, |p|) are not cut further: a thousand times the rounding of double.
constexpr double kResolution = 0x1p-40;
// ... and where a segment ends behind the surface, so much before that may stay open: the root that is reported may
// be another one than the first, and no further from it. A 256th of the least that float tells apart at 1.
constexpr double kRootResolution = 0x1p-30;
// Intervals cost many evaluations: worth it where a segment is so much longer than what its near end excludes of it.
// Those of iterated maps, where the field says that they tell little, cost a hundred.
constexpr double kRangeRatio = 8, kCostlyRangeRatio = 64;
// They told something when the bounds on the slope are so much tighter.
constexpr double kProgress = 0.8;
// Where they told nothing a segment this many times shorter is asked of next, longer ones only after so many
// evaluations, and then twice as many.
constexpr double kShorter = 8;
constexpr std::uint32_t kSeldom = 1u << 10;
// In a large scene an interval takes the whole program and an evaluation little of it. They are asked after this many
// evaluations, or this share of the program's instructions, and after as many again.
constexpr std::uint32_t kLeastAsked = 16, kAskedShare = 4;
// A step's length in what it should be for the balls of both ends just to touch, and the slope that is expected at
// most, relative to the bound on it (compare tiered-inl.h).
constexpr double kReach = 0.995, kLargestSlope = 0.9;
// Near a root a step is aimed beyond it by this share of the way.
constexpr double kOvershoot = 1.1;
constexpr int kMostRounds = 200;  // of a bracket
// Within a solid a field of 0, give or take so many roundings, is a surface where it goes on for longer than this
// times max(1, |p|). Where it does not, two parts of the solid touch there.
constexpr double kLevelRoundings = 4, kLeastLevel = 0x1p-20;

}  // namespace

Search::Search(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, const Stretch& stretch)
    : field_(&field),
      origin_(origin),
      direction_(direction),
      side_(side),
      speed_(field.lipschitz * glm::length(direction)),
      stretch_(stretch),
      back_(stretch.hint - stretch.begin),
      done_(false),
      range_ratio_(std::isfinite(field.longest_told) ? kCostlyRangeRatio : kRangeRatio),
      hopeless_(field.longest_told / glm::length(direction)),
      dear_(field.far_levels.used() ? std::max(kLeastAsked, field.distance->instructions() / kAskedShare) : 0),
      ask_at_(dear_ > 0 ? dear_ : kSeldom) {
  ask(stretch.begin, Purpose::Begin);
}

void Search::ask(double t, Purpose purpose) {
  wanted_ = t;
  purpose_ = purpose;
}

void Search::give(double f, std::uint64_t instructions, RealScratch& scratch) {
  ++result_.evaluations;
  result_.instructions += instructions;
  rounding_ = field_->rounding(point());
  if (side_ == 0) side_ = f < -rounding_ ? -1 : 1;
  if (!std::isfinite(f)) return end(Arrival::Status::Invalid);
  // Raised by what may be rounding, so that g is nowhere below 0 where the field is 0.
  const double g = (side_ < 0 ? -f : f) + rounding_;
  switch (purpose_) {
    case Purpose::Begin:
      return begin(g);
    case Purpose::End:
      now_.gb = g;
      if (!pending_.empty() && pending_.back().a == now_.b) pending_.back().ga = g;
      return go_on(scratch);
    case Purpose::Cut:
      if (cut(g)) go_on(scratch);
      return;
    case Purpose::Root:
      return narrow_bracket(g - root_level_);
  }
}

// Where g > 0 the search begins.
void Search::begin(double g) {
  double& from = stretch_.begin;
  if (g < 0 && back_ > 0 && from > 0) {
    from = std::max(0.0, from - back_);
    back_ *= 2;
    return ask(from, Purpose::Begin);
  }
  if (g < 0) return hit(from, from);
  now_ = {from, g, stretch_.end, 0, speed_, speed_};
  if (stretch_.hint > from && stretch_.hint < stretch_.end) {
    now_.b = stretch_.hint;
    // Its value at the hint is that at the near part's end.
    pending_.push_back({now_.b, g, stretch_.end, std::nan(""), speed_, speed_});
  }
  ask(now_.b, Purpose::End);
}

// Goes on with the near part, or with the far one where nothing is to be done but that: then no segment is kept.
// False when the search is done, or the near part the root's.
bool Search::cut(double g) {
  const Segment nearer{now_.a, now_.ga, wanted_, g, now_.fall, now_.rise};
  if (is_free(nearer, gap_of(nearer)) && !hides_end(nearer)) {
    now_.a = wanted_, now_.ga = g;
    return leave_behind(nearer);
  }
  if (g >= 0) pending_.push_back({wanted_, g, now_.b, now_.gb, now_.fall, now_.rise});
  now_ = nearer;
  return true;
}

// Settles the nearest segment, again and again, until a value is wanted.
void Search::go_on(RealScratch& scratch) {
  while (settle(scratch)) {
    if (pending_.empty()) return end(contact_ ? Arrival::Status::Contact : Arrival::Status::Miss);
    now_ = pending_.back();
    pending_.pop_back();
    if (std::isnan(now_.gb)) return ask(now_.b, Purpose::End);
  }
}

// Whether the segment is done with: free, or too short to tell. Else it is the root's or to be cut in two, and a
// value is wanted.
bool Search::settle(RealScratch& scratch) {
  Segment& s = now_;
  Gap gap = gap_of(s);
  bool free = is_free(s, gap);
  Told told = Told::Nothing;
  if (!free && worth_narrowing(s, gap)) {
    told = narrow(s, scratch);
    gap = gap_of(s);
    free = told == Told::Free || is_free(s, gap);
    if (!free && told == Told::Slope && s.gb < 0 && s.rise <= 0) {
      find_root(s, 0);
      return false;
    }
  }
  if (free && hides_end(s)) {
    ask((s.a + s.b) / 2, Purpose::Cut);
    return false;
  }
  if (free) return leave_behind(s);
  const double open = gap.hi - gap.lo, middle = (gap.lo + gap.hi) / 2;
  if (open <= coarsened(s.gb < 0 ? kRootResolution : kResolution, middle) || !(middle > s.a && middle < s.b)) {
    if (s.gb < 0) {
      find_root(s, std::min(s.b, gap.hi) - std::max(s.a, gap.lo));
      return false;
    }
    contact_ = true;
    // Beyond what nothing is told of, as where a field comes down to a plateau, longer segments are asked of again.
    hopeless_ = std::max(hopeless_, kShorter * (s.b - s.a));
    return side_ > 0 || !ends_solid(s, true);
  }
  ask(told == Told::Slope ? middle : std::min(middle, place_to_cut(s, gap)), Purpose::Cut);
  return false;
}

// Goes on beyond a segment that is free. False when it turns out that the solid ended before.
bool Search::leave_behind(const Segment& s) {
  slope_ = (s.gb - s.ga) / (s.b - s.a);
  return side_ > 0 || !ends_solid(s, is_still(s));
}

// Of a segment whose ends are level with 0: whether all of it is.
bool Search::is_still(const Segment& s) const {
  return std::min(s.fall, s.rise) * (s.b - s.a) <= kLevelRoundings * rounding_;
}

// Whether a segment of a solid that is free may be level with 0 for long, beside an end that is.
bool Search::hides_end(const Segment& s) const {
  const double level = kLevelRoundings * rounding_;
  if (side_ > 0 || (s.ga > level && s.gb > level) || s.b - s.a <= kLeastLevel * scale(s.a)) return false;
  return s.ga > level || s.gb > level || !is_still(s);
}

// Whether a solid has ended by the end of a segment of it. `still`: nothing rises far within it.
bool Search::ends_solid(const Segment& s, bool still) {
  const double level = kLevelRoundings * rounding_;
  if (s.gb > level) {
    above_ = s.b, g_above_ = s.gb;
  } else if (s.ga > level) {
    above_ = s.a, g_above_ = s.ga;
  } else if (still) {
    if (std::isnan(level_from_)) level_from_ = s.a, g_level_ = s.ga;
    if (s.b - level_from_ <= kLeastLevel * scale(level_from_)) return false;
    leave_solid(level);
    return true;
  }
  level_from_ = std::nan("");
  return false;
}

// The solid ended where g came down to the level it has had since.
void Search::leave_solid(double level) {
  if (g_above_ == 0) return hit(level_from_, level_from_);
  root_level_ = 2 * level;
  find_root({above_, g_above_ - root_level_, level_from_, g_level_ - root_level_, 0, 0}, 0);
}

// Where intervals may tell something of the near part; else where the balls of the near end and of the sample should
// just touch, if g goes on as it did; near a root, just beyond it.
double Search::place_to_cut(const Segment& s, const Gap& gap) const {
  const double near = gap.lo - s.a, slope = std::clamp(slope_, -s.fall, kLargestSlope * s.rise);
  const double least = gap.lo + coarsened(kResolution, gap.lo);
  if (hopeless_ > range_ratio_ * near) return std::max(s.a + hopeless_, least);
  double step = kReach * (near + s.ga / s.rise) / (1 - slope / s.rise);
  if (slope < 0) {
    const double open = 0.75 * coarsened(kRootResolution, gap.lo);
    step = std::max(step, std::min(kOvershoot * s.ga / -slope, near + open));
  }
  return std::max(s.a + step, least);
}

bool Search::is_free(const Segment& s, const Gap& gap) { return s.gb >= 0 && gap.lo > gap.hi; }

// g can be below zero only where neither end's value and slope keep it from it; empty (lo > hi) when that is nowhere.
Search::Gap Search::gap_of(const Segment& s) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double lo = s.fall > 0 ? s.a + s.ga / s.fall : infinity;
  if (s.gb < 0) return {std::min(lo, s.b), s.b};
  const double hi = s.rise > 0 ? s.b - s.gb / s.rise : -infinity;
  return {lo, hi};
}

bool Search::worth_narrowing(const Segment& s, const Gap& gap) {
  const double length = s.b - s.a;
  if (length <= range_ratio_ * (gap.lo - s.a)) return false;
  if (length <= hopeless_ && dear_ == 0) return true;
  if (result_.evaluations < ask_at_) return false;
  ask_at_ = dear_ > 0 ? result_.evaluations + dear_ : 2 * ask_at_;
  return true;
}

// Takes what interval arithmetic knows of the segment.
Search::Told Search::narrow(Segment& s, RealScratch& scratch) {
  ++result_.evaluations;
  const double length = s.b - s.a, known = s.fall + s.rise;
  std::optional<vm::AlongLine> line = field_->along(origin_, direction_, s.a, s.b, scratch, result_.instructions);
  bool free = false;
  if (line) {
    const auto [lo, hi] = line->derivative;
    s.fall = std::min(s.fall, std::max(0.0, side_ < 0 ? hi : -lo));
    s.rise = std::min(s.rise, std::max(0.0, side_ < 0 ? -lo : hi));
    // The value tells of a plateau where the derivative is that of what lies about it. Outside a solid it is free; a
    // solid ends there. No place is rounded less than the origin.
    const double flat = field_->rounding({});
    const bool empty = line->value.lo >= -flat;
    if (side_ > 0) {
      free = empty;
    } else if (empty && (s.gb >= 0 || length > kLeastLevel * scale(s.a))) {
      free = true;
      s.fall = s.rise = 0;
    } else {
      free = line->value.hi < 0;
    }
  }
  const bool told = free || s.fall + s.rise < kProgress * known;
  hopeless_ = told ? std::max(hopeless_, kShorter * length) : length / kShorter;
  return free ? Told::Free : told ? Told::Slope : Told::Nothing;
}

// g falls from above zero at a to zero or below at b, and the first root is in a stretch of that width: the Illinois
// method (Dowell and Jarratt, "A Modified Regula Falsi Method", 1971).
void Search::find_root(const Segment& s, double width) {
  bracket_ = {s.a, s.b, s.ga, s.gb, 0, 0};
  width_ = width;
  next_of_bracket();
}

void Search::next_of_bracket() {
  const Bracket& b = bracket_;
  const double width = b.hi - b.lo, least = 0.25 * kResolution * scale(b.hi);
  if (width <= 2 * least || b.g_hi == 0 || b.rounds == kMostRounds) return hit(b.g_hi == 0 ? b.hi : b.lo, b.hi);
  const double secant = b.lo + width * (b.rounds % 8 == 7 ? 0.5 : b.g_lo / (b.g_lo - b.g_hi));
  ask(std::clamp(secant, b.lo + least, b.hi - least), Purpose::Root);
}

void Search::narrow_bracket(double g) {
  Bracket& b = bracket_;
  if (g > 0) {
    b.lo = wanted_, b.g_lo = g;
    if (b.kept > 0) b.g_hi *= 0.5;
    b.kept = 1;
  } else {
    b.hi = wanted_, b.g_hi = g;
    if (b.kept < 0) b.g_lo *= 0.5;
    b.kept = -1;
  }
  ++b.rounds;
  next_of_bracket();
}

double Search::scale(double t) const {
  const glm::dvec3 p = glm::abs(origin_ + t * direction_);
  return std::max({1.0, p.x, p.y, p.z});
}
double Search::coarsened(double resolution, double t) const {
  const double finest = resolution * scale(t);
  if (result_.evaluations <= kSearchBudget) return finest;
  const double coarser = std::ldexp(finest, static_cast<int>((result_.evaluations - kSearchBudget) / kCoarsening));
  return std::min(coarser, std::max(finest, kCoarsest * std::min(scale(t), stretch_.end - stretch_.begin)));
}

void Search::hit(double lo, double hi) {
  result_.t = (lo + hi) / 2;
  result_.width = std::max({hi - lo, width_, 0.0});
  end(Arrival::Status::Hit);
}

void Search::end(Arrival::Status status) {
  result_.status = status;
  result_.side = side_ < 0 ? -1 : 1;
  done_ = true;
}

}  // namespace fathom::runtime
