#include "runtime/march/piece_stream.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/march/stream.h"

namespace fathom::runtime {
namespace {

// Evaluations after which advance() returns, so that its caller may stop where each takes microseconds.
constexpr std::size_t kMaxEvaluations = 1 << 14;

}  // namespace

PieceStream::PieceStream(const Pieces& pieces, std::uint32_t number, const Marching& marching)
    : pieces_(pieces),
      template_(pieces.templates[number]),
      rules_(make_rules<float>(template_.field, marching)),
      register_lanes_(register_lanes()),
      lanes_(new Lanes<float>()) {
  static_assert(kLanes <= vm::kMaxRowLanes);
  convex_.fill(std::numeric_limits<float>::infinity());
  if (template_.per_lane) constants_.resize(vm::constants_in(template_.code) * vm::kRowStride);
}

void PieceStream::start(std::uint32_t ray, std::int32_t piece, glm::dvec3 origin, glm::dvec3 direction, double begin,
                        double end, int side, float slope) {
  ++live_;
  std::size_t lane = lanes_used_;
  if (free_lanes_.empty()) {
    ++lanes_used_;
  } else {
    lane = free_lanes_.back();
    free_lanes_.pop_back();
  }
  float* const first = &lanes_->row[0][lane];
  const auto put = [&](int row, float value) { first[row * static_cast<int>(Lanes<float>::kStride)] = value; };
  for (int axis = 0; axis < 3; ++axis) {
    const auto from = static_cast<float>(origin[axis] + begin * direction[axis]);
    put(kX + axis, from);
    put(kOx + axis, from);
    put(kDx + axis, static_cast<float>(direction[axis]));
  }
  for (const LaneRow zero : {kPhase, kTNext, kEvaluations, kT, kG, kR, kBackoffCount}) put(zero, 0);
  put(kTMax, static_cast<float>((end - begin) * (1 - 0x1p-24)));
  put(kBefore, static_cast<float>(begin));
  put(kSide, static_cast<float>(side));
  put(kM, std::clamp(slope, -1.0f, 0.9f));
  put(kBackoff, static_cast<float>(kFirstBackoff));
  ray_[lane] = ray;
  if (!template_.per_lane) return;
  const std::vector<float>& row = pieces_.rows[static_cast<std::size_t>(piece)];
  for (std::size_t k = 0; k < row.size(); ++k) constants_[k * vm::kRowStride + lane] = row[k];
}

void PieceStream::compact_lanes() {
  for (const std::size_t free_lane : free_lanes_) {
    const std::size_t last = --lanes_used_;
    if (free_lane == last) continue;
    for (auto& row : lanes_->row) row[free_lane] = row[last];
    ray_[free_lane] = ray_[last];
    for (std::size_t k = 0; k < constants_.size(); k += vm::kRowStride)
      constants_[k + free_lane] = constants_[k + last];
  }
  free_lanes_.clear();
}

void PieceStream::advance(std::size_t few, std::vector<Ended>& ended, MarchCounters& counters,
                          vm::Workspace& workspace) {
  std::size_t points = 0;
  do {
    compact_lanes();
    points += live_;
    const auto& row = lanes_->row;
    template_.evaluate({row[kX], row[kY], row[kZ]}, live_, constants_.data(), distance_.data(), scratch_, workspace);
    counters.evaluations += live_;
    counters.lanes += (live_ + register_lanes_ - 1) / register_lanes_ * register_lanes_;
    const FieldSamples<float> at{distance_.data(), template_.convex ? convex_.data() : nullptr};
    LaneNumbers numbers;
    for (std::size_t i = runtime::advance(*lanes_, live_, at, rules_, numbers); i-- > 0;)
      ended.push_back(finish(numbers[i], counters));
  } while (live_ >= few && live_ > 0 && points < kMaxEvaluations);
}

PieceStream::Ended PieceStream::finish(std::size_t i, MarchCounters& counters) {
  const auto number = [&](auto row) { return lanes_->row[row][i]; };
  --live_;
  free_lanes_.push_back(i);
  Ended ended{ray_[i],        static_cast<LaneVerdict>(number(kVerdict)),       number(kRoot),
              number(kWidth), static_cast<std::uint32_t>(number(kEvaluations)), {}};
  if (ended.verdict == LaneVerdict::Certify)
    ended.rest = undecided_interval(*lanes_, i, static_cast<double>(number(kTMax)), template_.field.band);
  if (ended.verdict == LaneVerdict::Invalid) counters.note_invalid({number(kX), number(kY), number(kZ)});
  return ended;
}

}  // namespace fathom::runtime
