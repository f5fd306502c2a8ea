#include "runtime/units.h"

#include <algorithm>
#include <utility>

#include "runtime/base/tiles.h"

namespace fathom::runtime {

std::vector<SampleRange> split_into_rounds(SampleRange samples, std::uint32_t first) {
  std::vector<SampleRange> rounds;
  std::uint32_t begin = samples.first, size = first;
  while (begin < samples.last) {
    const std::uint32_t end = begin + std::min(size, samples.last - begin);
    rounds.push_back({begin, end});
    begin = end;
    size = std::min(begin - samples.first, kMaxInRound);
  }
  return rounds;
}

UnitQueue::UnitQueue(PixelRect area, int tile_side, std::vector<SampleRange> rounds, const Coverage& covered)
    : area_(area), side_(tile_side), rounds_(std::move(rounds)), covered_(covered) {}

std::optional<SampleBlock> UnitQueue::take() {
  const std::lock_guard lock(mutex_);
  while (pieces_.empty()) {
    if (!next_tile()) return std::nullopt;
  }
  const SampleBlock unit = pieces_.back();
  pieces_.pop_back();
  return unit;
}

bool UnitQueue::next_tile() {
  if (round_ == rounds_.size()) return false;
  const Tiles tiles(area_, side_);
  pieces_ = covered_.missing({tiles.at(tile_), rounds_[round_]});
  if (++tile_ == tiles.count()) {
    tile_ = 0;
    ++round_;
  }
  return true;
}

}  // namespace fathom::runtime
