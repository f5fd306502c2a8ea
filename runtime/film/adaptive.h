// Adaptive sampling without bias: noisy tiles of an image get more samples, and tiles whose noise is below a
// threshold get no more.
//
// A pixel's samples are two halves A and B with independent random numbers. The samples of B decide how many samples
// A takes, and the samples of A decide for B. The expected mean of each half is therefore the true value, whatever is
// decided, and a pixel is the mean of the two means. Deciding by the samples themselves is biased: a pixel whose
// samples all missed a light looks quiet, gets no more samples and stays dark (Kirk and Arvo, "Unbiased Sampling
// Techniques for Image Synthesis", 1991).
//
//     for (end = next_round(0, ...); end != 0; end = next_round(end, ...)) {
//       take the samples up to `end` of both halves of all open tiles: of half h for stage h of the film, or for
//       stage h + 2 if half h is decided
//       judge(film, end, threshold, state);
//     }
//     assign_shares(film, spp, threshold, state);
//     take the samples up to AdaptiveTile::ends of both halves
//
// A half that is decided before the other half of its tile takes samples for the other half's decision only. Stages 2
// and 3 of the film hold these samples, and no mean uses them.
//
// The numbers of samples follow the square root of the standard deviation, halfway between the same number everywhere
// and the numbers that minimise the error if the deviations were known. Estimated deviations miss rare bright paths.
// By simulation with 6 samples of each half, 16x16 pixels per tile and a Cornell box with a mirror ball and a glass
// box, following the variance raises relMSE by 10 %, following this rule lowers it by 2 %.
// Tested by: tests/runtime/film/adaptive_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "runtime/base/pixel_rect.h"

namespace fathom::runtime {

class Film;

inline constexpr double kDark = 0.01;     // luminance below which noise is not visible
inline constexpr int kAdaptiveTile = 16;  // side of a tile, pixels; tiles begin at the image's corner
inline constexpr int kMinAdaptiveSpp = 8;

struct AdaptiveTile {
  std::array<std::uint32_t, 2> ends = {0, 0};  // number of samples of each half; 0: not decided

  bool open() const { return ends[0] == 0 || ends[1] == 0; }
  bool operator==(const AdaptiveTile&) const = default;
};

struct AdaptiveState {
  std::uint32_t judged = 0;         // number of samples of each half at the last judgement
  std::vector<AdaptiveTile> tiles;  // [tile of Tiles(area, kAdaptiveTile)]; empty: the same number everywhere

  bool operator==(const AdaptiveState&) const = default;
};

// Returns the number of stages of the film: the two halves, and with a threshold above 0 two more stages for samples
// that only decide.
std::size_t adaptive_stages(double threshold);

// Returns the seed of the random numbers of half B.
std::uint64_t second_seed(std::uint64_t seed);

// Returns the number of samples of each half at the next judgement, or 0 after the last one, which has a quarter of
// the samples. `spp` is the average over the image, at least kMinAdaptiveSpp.
std::uint32_t next_round(std::uint32_t judged, int spp, double threshold);

// Returns the noise of an image made of two halves, each like the sum of the given stages: the root of the mean over
// the tile's pixels of v / (2 (b + kDark)), with v the variance of the half's mean luminance and b the half's
// luminance. This measure is the error as the eye sees it, a standard deviation over the root of the luminance
// (Dammertz, Hanika, Keller, Lensch, "A Hierarchical Automatic Stopping Condition for Monte Carlo Global
// Illumination", 2010).
double noise_of(const Film& film, PixelRect tile, std::initializer_list<std::size_t> stages);

// Returns the noise of the image that the film shows, in the same measure.
double image_noise(const Film& film, PixelRect tile);

// Decides each half of an open tile for which the other half measures a noise of at most `threshold`. The halves of
// open tiles have `end` samples.
void judge(const Film& film, std::uint32_t end, double threshold, AdaptiveState& state);

// Decides all halves that are still undecided. All halves together have at most `spp` samples per pixel of the image.
// A half gets between half and four times the average, or fewer samples if fewer are enough for the threshold.
void assign_shares(const Film& film, int spp, double threshold, AdaptiveState& state);

}  // namespace fathom::runtime
