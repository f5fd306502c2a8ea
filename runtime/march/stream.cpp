#include "runtime/march/stream.h"

#include <algorithm>

#include "runtime/field/pieces.h"

namespace fathom::runtime {
namespace {

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

// Returns an S that is not above `value`, and below by at most a unit in its last place.
template <class S>
S round_down(double value) {
  return static_cast<S>(sizeof(S) == sizeof(float) ? value * (1 - 0x1p-24) : value);
}

// Samples to accept after the first attempt to cross that met no surface.
constexpr double kFirstBackoff = 2;
// Margin around the bracket of a vague root, relative to t, in which the search looks for the root first (kTolerance
// in tiered-inl.h).
constexpr double kBracketMargin = 0x1p-14;

// Number of lanes for a field without regions: a block of the machine.
constexpr int kBlock = 256;
static_assert(Lanes<float>::kCapacity <= kMaxPoints);

}  // namespace

template <class S>
Stream<S>::Stream(const Field& field, const Marching& marching, const PieceStream& source)
    : Marcher(field),
      source_(source),
      per_lane_(source.pieces && source.pieces->templates[source.number].per_lane),
      rules_(make_rules<S>(field, marching)),
      lanes_(new Lanes<S>()),
      uses_epsilon_(info(rules_.method).uses_epsilon),
      takes_slope_hint_(!uses_epsilon_),
      max_lanes_(field.regions || source.pieces ? static_cast<int>(kLanes) : kBlock),
      use_convexity_(sizeof(S) == sizeof(float) && marching.method == Method::Tiered &&
                     (source.pieces ? source.pieces->templates[source.number].convex : field.has_convexity())),
      register_lanes_(sizeof(S) == sizeof(float) ? register_lanes() : 1) {
  static_assert(kLanes <= vm::kMaxRowLanes);
  if (!source.pieces) return;
  convex_.fill(std::numeric_limits<S>::infinity());
  if (per_lane_) {
    constants_.resize(vm::constants_in(source.pieces->templates[source.number].code) * vm::kRowStride);
  }
}

// Returns the field of the lane's ray.
template <class S>
const Field& Stream<S>::field_of(std::size_t lane) const {
  return source_.pieces ? source_.pieces->fields[source_.piece_of[clipped_rays_[lane].id]] : field_;
}

template <class S>
void Stream<S>::begin(RayBlock& rays) {
  while (rays.count > 0 && live_ < max_lanes_) {
    const std::size_t i = --rays.count;
    if (!enters(rays, i)) continue;
    const std::size_t lane = take_lane();
    set_clipped_ray(clipped_rays_[lane], rays, i);
    start_lane(lane, rays.side[i], rays.slope[i]);
  }
}

template <class S>
void Stream<S>::start(const ClippedRay& ray, int side, float slope) {
  const std::size_t lane = take_lane();
  clipped_rays_[lane] = ray;
  start_lane(lane, side, slope);
}

template <class S>
std::size_t Stream<S>::take_lane() {
  ++live_;
  if (free_lanes_.empty()) return lanes_used_++;
  const std::size_t lane = free_lanes_.back();
  free_lanes_.pop_back();
  return lane;
}

// Sets the state of the lane to that before the first evaluation of its clipped ray.
template <class S>
void Stream<S>::start_lane(std::size_t lane, int side, float slope) {
  const ClippedRay& ray = clipped_rays_[lane];
  S* const first = &lanes_->row[0][lane];
  const auto put = [&](int row, S value) { first[row * static_cast<int>(Lanes<S>::kStride)] = value; };
  for (int axis = 0; axis < 3; ++axis) {
    const S origin = static_cast<S>(ray.origin[axis]);
    put(kX + axis, origin);
    put(kOx + axis, origin);
    put(kDx + axis, static_cast<S>(ray.direction[axis]));
  }
  for (const LaneRow zero : {kPhase, kTNext, kEvaluations, kT, kG, kR, kBackoffCount}) put(zero, 0);
  put(kTMax, round_down<S>(ray.length));
  put(kSide, static_cast<S>(side));
  put(kM, takes_slope_hint_ ? std::clamp(static_cast<S>(slope), S(-1), S(0.9)) : S(-1));
  put(takes_slope_hint_ ? int{kBackoff} : int{kOverstepped}, takes_slope_hint_ ? S(kFirstBackoff) : S(1));
  if (per_lane_) {
    const std::vector<float>& row = source_.pieces->rows[source_.piece_of[ray.id]];
    for (std::size_t k = 0; k < row.size(); ++k) constants_[k * vm::kRowStride + lane] = row[k];
  }
  instructions_[lane] = 0;
}

template <>
void Stream<float>::evaluate() {
  const auto& row = lanes_->row;
  const auto count = static_cast<std::size_t>(live_);
  const vm::Points points{row[kX], row[kY], row[kZ]};
  if (source_.pieces) {
    source_.pieces->templates[source_.number].evaluate(points, count, constants_.data(), distance_.data(), scratch_,
                                                       workspace_);
  } else if (use_convexity_) {
    return field_.evaluate_convex(points, count, distance_.data(), convex_.data(), workspace_);
  } else {
    field_.evaluate(points, count, distance_.data(), scratch_, workspace_);
  }
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
    for (std::size_t k = 0; k < constants_.size(); k += vm::kRowStride)
      constants_[k + free_lane] = constants_[k + last];
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
    return certify_from(field_of(i), ray, side, undecided_interval(i), evaluations, instructions);
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

// Returns the part of a lane's ray that float has not decided. If float knows a root too loosely, the search begins
// with the bracket, widened by the uncertainty. The interval ends before the ray in a field with cells: further on,
// float may know more.
template <class S>
RayInterval Stream<S>::undecided_interval(std::size_t i) const {
  const auto number = [&](auto row) { return static_cast<double>(lanes_->row[row][i]); };
  RayInterval interval{number(kT), clipped_rays_[i].length, 0};
  if (number(kPhase) == static_cast<double>(LanePhase::Refine)) {
    const double slack = std::max(kBracketMargin * number(kTHi), static_cast<double>(field_.band));
    interval.begin = std::max(0.0, number(kTLo) - slack);
    interval.hint = number(kTHi) + slack;
  }
  if (field_.cells)
    interval.end = std::min(interval.end, std::max(interval.begin, interval.hint) + field_.cells->stretch());
  return interval;
}

template class Stream<float>;
template class Stream<double>;

}  // namespace fathom::runtime
