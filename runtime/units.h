// Units of a render's work: a range of samples of the pixels of a tile.
//
// A unit has a film of its own for its sums. The worker adds this film to the image's film when the unit is complete.
// The image's film therefore contains whole units at any moment and can be saved, and no two threads write to the
// same pixel. Long renders go over the image in rounds, so that an image of the samples so far covers all pixels.
//
// Tested by: tests/runtime/units_test.cpp
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "runtime/base/coverage.h"

namespace fathom::runtime {

// Cuts a range of samples into rounds: first the first `first` samples, then each time as many samples as all rounds
// before together, up to kMaxInRound, which keeps units short.
inline constexpr std::uint32_t kFirstRound = 16, kMaxInRound = 256;
std::vector<SampleRange> split_into_rounds(SampleRange samples, std::uint32_t first = kFirstRound);

// Queue of the units that are left: round by round, tile by tile, without covered samples. Any thread may call
// take().
class UnitQueue {
 public:
  // `covered` must be canonical and must outlive the queue.
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
  std::vector<SampleBlock> pieces_;  // units of the last tile; take() takes them from the back
};

}  // namespace fathom::runtime
