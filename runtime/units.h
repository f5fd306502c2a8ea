// The work of a render, in units: the samples of a range, of the pixels of a tile.
//
// A unit's samples are summed in a film of its own, which is added to the picture's once all of them are there. So
// the picture's film holds whole units at any moment and can be kept, and none of its pixels is written to by two
// threads. Long renders go over the picture in rounds, so that a picture of what there is so far is a whole picture.
//
// Tested by: tests/runtime/units_test.cpp
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "runtime/base/coverage.h"

namespace fathom::runtime {

// A range of samples cut into rounds: the first `first` of them, then as many as there were before, up to a limit
// that keeps units short.
inline constexpr std::uint32_t kFirstRound = 16, kMostInRound = 256;
std::vector<SampleRange> rounds_of(SampleRange samples, std::uint32_t first = kFirstRound);

// The units that are left: round by round, tile by tile, without what is covered. take() is safe from any thread.
class UnitQueue {
 public:
  // `covered` must be tidy and live as long as the queue.
  UnitQueue(PixelRect area, int tile_side, std::vector<SampleRange> rounds, const Coverage& covered);

  std::optional<SampleBlock> take();

 private:
  bool next_tile();

  const PixelRect area_;
  const int side_;
  const std::vector<SampleRange> rounds_;
  const Coverage& covered_;
  std::mutex mutex_;
  std::size_t round_ = 0;
  std::int64_t tile_ = 0;
  std::vector<SampleBlock> pieces_;  // of the last tile, to be taken from the back
};

}  // namespace fathom::runtime
