// Adaptive sampling without bias: noisy tiles of an image get more samples, and tiles whose noise is below a
// threshold get no more.
//
// The pixels are two halves, like the fields of a chessboard: pixels with an even x + y, and the others. The samples
// of each half decide how many samples the pixels of the other half take. So a pixel's own samples do not decide
// their number, and its expected mean is the true value, whatever is decided. A pixel that decides by its own samples
// is biased: if all of them missed a light, the pixel looks quiet, gets no more samples and stays dark (Kirk and
// Arvo, "Unbiased Sampling Techniques for Image Synthesis", 1991). The sampler `blue` makes the errors of neighbours
// depend on each other, which leaves a bias too small to be measured.
//
//     for (end = next_round(0, ...); end != 0; end = next_round(end, ...)) {
//       take the samples up to `end` of the pixels of open tiles: for stage 0 of the film, or for stage 1 if the
//       pixel's number of samples is decided
//       test_convergence(film, end, threshold, state);
//     }
//     allocate_samples(film, spp, threshold, state);
//     take the samples up to AdaptiveTile::ends
//
// Pixels whose number is decided before that of the other half of their tile take further samples only to decide for
// that half. Stage 1 of the film holds these samples, and no mean uses them.
//
// All samples of a pixel are of one sequence of the sampler, so they are as evenly spread as those of a uniform
// render.
//
// The numbers of samples follow the square root of the standard deviation, halfway between the same number everywhere
// and the numbers that minimise the error if the deviations were known. Estimated deviations miss rare bright paths.
// Tested by: tests/runtime/film/adaptive_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/base/pixel_rect.h"

namespace fathom::runtime {

class Film;

inline constexpr double kDark = 0.01;     // luminance below which noise is not visible
inline constexpr int kAdaptiveTile = 16;  // side of a tile, pixels; tiles begin at the image's corner
inline constexpr int kMinAdaptiveSpp = 8;

// Returns the half, 0 or 1, of a pixel.
constexpr std::size_t half_of(int x, int y) { return static_cast<std::size_t>((x ^ y) & 1); }

struct AdaptiveTile {
  std::array<std::uint32_t, 2> ends = {0, 0};  // number of samples of the pixels of each half; 0: not decided

  bool open() const { return ends[0] == 0 || ends[1] == 0; }
  bool operator==(const AdaptiveTile&) const = default;
};

struct AdaptiveState {
  std::uint32_t tested_spp = 0;     // number of samples per pixel at the last convergence test
  std::vector<AdaptiveTile> tiles;  // [tile of Tiles(area, kAdaptiveTile)]; empty: the same number everywhere

  bool used() const { return !tiles.empty(); }
  bool operator==(const AdaptiveState&) const = default;
};

// Returns the number of stages of the film: two with a threshold above 0.
std::size_t adaptive_stages(double threshold);

// Returns the number of samples per pixel at the next convergence test, or 0 after the last one, which has half of
// the samples. `spp` is the average over the image, at least kMinAdaptiveSpp.
std::uint32_t next_round(std::uint32_t tested_spp, int spp, double threshold);

// Returns the noise of the pixels of one half of a tile: the root of the mean of v / (b + kDark), with v the variance
// of the pixel's mean luminance and b the luminance. This measure is the error as the eye sees it, a standard
// deviation over the root of the luminance (Dammertz, Hanika, Keller, Lensch, "A Hierarchical Automatic Stopping
// Condition for Monte Carlo Global Illumination", 2010). Infinite if the tile has no such pixel. Counts the samples
// of all stages.
double noise_of(const Film& film, PixelRect tile, std::size_t half);

// Returns the noise of all pixels of a tile that the film shows, in the same measure.
double image_noise(const Film& film, PixelRect tile);

// Decides each half of an open tile for which the other half measures a noise of at most `threshold`. The pixels of
// open tiles have `end` samples.
void test_convergence(const Film& film, std::uint32_t end, double threshold, AdaptiveState& state);

// Decides all halves that are still undecided. All pixels of a half together have at most `spp` samples per pixel. A
// pixel gets between half and four times the average, or fewer samples if fewer are enough for the threshold.
void allocate_samples(const Film& film, int spp, double threshold, AdaptiveState& state);

}  // namespace fathom::runtime
