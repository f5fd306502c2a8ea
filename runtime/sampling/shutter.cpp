#include "runtime/sampling/shutter.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

// Returns a random number in [0,1), a multiple of 2^-53.
double random_of(std::uint64_t seed, int frame, int run) {
  std::uint64_t hash = mix64(seed + kGoldenGamma);
  hash = mix64(hash + kGoldenGamma * (static_cast<std::uint64_t>(frame) + 1));
  hash = mix64(hash + kGoldenGamma * (static_cast<std::uint64_t>(run) + 1));
  return static_cast<double>(hash >> 11) * 0x1p-53;
}

}  // namespace

std::vector<ShutterInterval> shutter_intervals(int spp, int times, std::uint64_t seed, int frame) {
  const std::int64_t pairs = spp / 2;
  const int count = std::max(1, std::min(times, static_cast<int>(pairs)));
  std::vector<ShutterInterval> runs;
  std::uint32_t first = 0;
  for (int run = 0; run < count; ++run) {
    // The last run takes the sample that is left of an odd number.
    const bool last = run + 1 == count;
    const auto end = static_cast<std::uint32_t>(last ? spp : 2 * (pairs * (run + 1) / count));
    const double time = (first + random_of(seed, frame, run) * (end - first)) / spp;
    // Rounding up must not show the first moment of the next frame.
    runs.push_back({{first, end}, std::min(time, 0x1.fffffffffffffp-1)});
    first = end;
  }
  return runs;
}

}  // namespace fathom::runtime
