#include "runtime/march/stream.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

// Margin around the bracket of a vague root, relative to t, in which the search looks for the root first (kTolerance
// in tiered-inl.h).
constexpr double kBracketMargin = 0x1p-14;

}  // namespace

template <class S>
LaneRules<S> make_rules(const Field& field, const Marching& marching) {
  constexpr bool kSingle = sizeof(S) == sizeof(float);
  LaneRules<S> rules{};
  rules.lipschitz = static_cast<S>(field.step_lipschitz());
  rules.inv_lipschitz = static_cast<S>(1 / field.step_lipschitz());
  rules.band = static_cast<S>(field.band);
  rules.cancellation = static_cast<S>(field.cancellation);
  // A double keeps 29 more bits, and the rounding of constants to float does not affect it.
  rules.unit =
      kSingle ? static_cast<S>(kDistanceError) : static_cast<S>(static_cast<double>(kDistanceError) * 0x1p-29);
  rules.resolution = kSingle ? static_cast<S>(0x1p-22) : static_cast<S>(0x1p-48);
  rules.method = marching.method;
  rules.epsilon = static_cast<S>(marching.epsilon);
  rules.steps = static_cast<S>(marching.steps);
  rules.relaxation = static_cast<S>(marching.relaxation);
  return rules;
}

template <class S>
RayInterval undecided_interval(const Lanes<S>& lanes, std::size_t i, double length, float band) {
  const auto number = [&](auto row) { return static_cast<double>(lanes.row[row][i]); };
  RayInterval interval{number(kT), length, 0};
  if (number(kPhase) == static_cast<double>(LanePhase::Refine)) {
    const double slack = std::max(kBracketMargin * number(kTHi), static_cast<double>(band));
    interval.begin = std::max(0.0, number(kTLo) - slack);
    interval.hint = number(kTHi) + slack;
  }
  return interval;
}

namespace {

// Returns an S that is not above `value`, and below by at most a unit in its last place.
template <class S>
S round_down(double value) {
  return static_cast<S>(sizeof(S) == sizeof(float) ? value * (1 - 0x1p-24) : value);
}

// Number of lanes for a field without regions: a block of the machine.
constexpr int kBlock = 256;
static_assert(Lanes<float>::kCapacity <= kMaxPoints);

}  // namespace

template <class S>
Stream<S>::Stream(const Field& field, const Marching& marching)
    : Marcher(field),
      rules_(make_rules<S>(field, marching)),
      lanes_(new Lanes<S>()),
      uses_epsilon_(info(rules_.method).uses_epsilon),
      takes_slope_hint_(!uses_epsilon_),
      max_lanes_(field.regions ? static_cast<int>(kLanes) : kBlock),
      use_convexity_(sizeof(S) == sizeof(float) && marching.method == Method::Tiered && field.has_convexity()),
      register_lanes_(sizeof(S) == sizeof(float) ? register_lanes() : 1) {}

template <class S>
void Stream<S>::begin(RayBlock& rays) {
  while (rays.count > 0 && live_ < max_lanes_) {
    const std::size_t i = --rays.count;
    if (enters(rays, i)) start_lane(rays, i);
  }
}

template <class S>
void Stream<S>::start_lane(const RayBlock& rays, std::size_t i) {
  ++live_;
  std::size_t lane = lanes_used_;
  if (free_lanes_.empty()) {
    ++lanes_used_;
  } else {
    lane = free_lanes_.back();
    free_lanes_.pop_back();
  }
  S* const first = &lanes_->row[0][lane];
  const auto put = [&](int row, S value) { first[row * static_cast<int>(Lanes<S>::kStride)] = value; };
  for (int axis = 0; axis < 3; ++axis) {
    const S origin = static_cast<S>(rays.origin[axis][i]);
    put(kX + axis, origin);
    put(kOx + axis, origin);
    put(kDx + axis, static_cast<S>(rays.direction[axis][i]));
  }
  for (const LaneRow zero : {kPhase, kTNext, kEvaluations, kT, kG, kR, kBackoffCount}) put(zero, 0);
  put(kTMax, round_down<S>(rays.length[i]));
  put(kSide, rays.side[i]);
  put(kM, takes_slope_hint_ ? std::clamp(static_cast<S>(rays.slope[i]), S(-1), S(0.9)) : S(-1));
  put(takes_slope_hint_ ? int{kBackoff} : int{kOverstepped}, takes_slope_hint_ ? S(kFirstBackoff) : S(1));
  set_clipped_ray(clipped_rays_[lane], rays, i);
  instructions_[lane] = 0;
}

template <>
void Stream<float>::evaluate() {
  const auto& row = lanes_->row;
  const auto count = static_cast<std::size_t>(live_);
  const vm::Points points{row[kX], row[kY], row[kZ]};
  if (use_convexity_) {
    return field_.evaluate_convex(points, count, distance_.data(), convex_.data(), workspace_);
  }
  field_.evaluate(points, count, distance_.data(), scratch_, workspace_);
  field_.to_steps(points, count, distance_.data());
  if (field_.regions) {
    for (std::size_t i = 0; i < count; ++i) instructions_[i] += scratch_.instructions[i];
  }
}

template <>
void Stream<double>::evaluate() {
  const auto& row = lanes_->row;
  for (std::size_t i = 0; i < static_cast<std::size_t>(live_); ++i) {
    const glm::dvec3 point(row[kX][i], row[kY][i], row[kZ][i]);
    distance_[i] = field_.to_step(field_.evaluate(point, real_scratch_, instructions_[i]), point);
  }
}

template <class S>
void Stream<S>::compact_lanes() {
  for (const std::size_t free_lane : free_lanes_) {
    const std::size_t last = --lanes_used_;
    if (free_lane == last) continue;
    for (auto& row : lanes_->row) row[free_lane] = row[last];
    clipped_rays_[free_lane] = clipped_rays_[last];
    instructions_[free_lane] = instructions_[last];
  }
  free_lanes_.clear();
}

template <class S>
void Stream<S>::step() {
  compact_lanes();
  evaluate();
  const std::size_t count = static_cast<std::size_t>(live_);
  counters_.evaluations += count;
  counters_.lanes += (count + register_lanes_ - 1) / register_lanes_ * register_lanes_;
  counters_.region_far = scratch_.counters.far, counters_.region_programs = scratch_.counters.specialised;
  const FieldSamples<S> at{distance_.data(), use_convexity_ ? convex_.data() : nullptr};
  LaneNumbers ended;
  for (std::size_t i = runtime::advance(*lanes_, count, at, rules_, ended); i-- > 0;) finish(ended[i]);
}

template <class S>
void Stream<S>::finish(std::size_t i) {
  const auto number = [&](auto row) { return lanes_->row[row][i]; };
  const ClippedRay& ray = clipped_rays_[i];
  const int side = number(kSide) < 0 ? -1 : 1;
  const std::uint32_t evaluations = static_cast<std::uint32_t>(number(kEvaluations));
  const std::uint64_t instructions =
      field_.regions ? instructions_[i] : std::uint64_t{evaluations} * field_.distance->instructions();
  --live_;
  free_lanes_.push_back(i);
  const auto verdict = static_cast<LaneVerdict>(number(kVerdict));
  if (verdict == LaneVerdict::Certify)
    return certify_from(field_, ray, side, undecided_interval(i), evaluations, instructions);
  RayHit::Status status = RayHit::Status::Miss;
  float width = 0;
  double t = 0;
  // Conditional moves, because a branch would be predicted wrong for every other ray.
  const bool hit = verdict == LaneVerdict::Hit;
  status = hit ? RayHit::Status::Hit : status;
  width = hit ? static_cast<float>(uses_epsilon_ ? rules_.epsilon : number(kWidth)) : width;
  t = hit ? ray.entry + static_cast<double>(number(kRoot)) : t;
  if (verdict == LaneVerdict::OutOfSteps) ++counters_.exhausted;
  if (verdict == LaneVerdict::Invalid) {
    counters_.note_invalid({number(kX), number(kY), number(kZ)});
    status = RayHit::Status::Invalid;
  }
  report(ray.id, status, static_cast<std::int8_t>(side), evaluations, 0u, width, t, instructions);
}

// The interval ends before the ray in a field with cells: further on, float may know more.
template <class S>
RayInterval Stream<S>::undecided_interval(std::size_t i) const {
  RayInterval interval = runtime::undecided_interval(*lanes_, i, clipped_rays_[i].length, field_.band);
  if (field_.cells)
    interval.end = std::min(interval.end, std::max(interval.begin, interval.hint) + field_.cells->stretch());
  return interval;
}

template LaneRules<float> make_rules(const Field& field, const Marching& marching);
template RayInterval undecided_interval(const Lanes<float>& lanes, std::size_t i, double length, float band);
template class Stream<float>;
template class Stream<double>;

}  // namespace fathom::runtime
