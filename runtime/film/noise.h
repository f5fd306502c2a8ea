// Stopping where a picture's noise is below a limit, by tile and without bias.
//
// Who stops when the samples so far agree stops too early where they agree by chance: where they all missed a light.
// So a pixel's samples are two halves A and B with random numbers of their own, and how many samples of A count is
// decided by B alone, and the other way round. Each mean is then expected to be the true one, whatever the decisions,
// and a pixel is half of the one plus half of the other (cf. Kirk and Arvo, "Unbiased Sampling Techniques for Image
// Synthesis", 1991).
//
// In rounds that double the samples, both halves of a tile go on until both are decided. A half that is decided
// before the other goes on for its judgement only: those samples are kept apart, in stages of the film that no mean
// looks at.
//
//     for (end = next_end(0, ...); ...; end = next_end(end, ...)) {
//       take samples up to `end` of both halves of all open tiles: half h to stage h, or, once decided, to h + 2
//       judge(film, end, limit, state);
//     }
//
// Tested by: tests/runtime/film/noise_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "runtime/base/pixel_rect.h"

namespace fathom::runtime {

class Film;

inline constexpr double kDark = 0.01;  // brightness below which noise is not visible
inline constexpr int kNoiseTile = 16;  // pixels; from the whole picture's corner, whatever tiles threads take
inline constexpr std::size_t kNoiseStages = 4;  // of the film: what counts of either half, what does not
inline constexpr int kLeastNoiseSpp = 4;        // below, a half has no variance
inline constexpr int kUsualLeastSpp = 16;       // before a tile may be judged, when not said

struct NoiseTile {
  std::array<std::uint32_t, 2> ends = {0, 0};  // how many samples of each half count; 0: not decided

  bool open() const { return ends[0] == 0 || ends[1] == 0; }
  bool operator==(const NoiseTile&) const = default;
};

struct NoiseState {
  std::uint32_t judged = 0;      // samples of each half at the last judgement
  std::vector<NoiseTile> tiles;  // of Tiles(area, kNoiseTile); empty: the render does without

  bool operator==(const NoiseState&) const = default;
};

// How many samples each half has at the next judgement, when a pixel gets at least `least` and at most `most` of both
// together, one of each half at a time; 0 when there is none.
std::uint32_t next_end(std::uint32_t judged, int least, int most);

// The noise of a picture made of two such halves: over a tile's pixels the root of the mean of
// v / (2 (b + 0.01)), v the variance of the half's mean luminance, b the luminance, over the samples of these stages.
// As runtime/film/adaptive.h has it: the error as the eye sees it, standard deviation over the root of brightness.
double noise_of(const Film& film, PixelRect tile, std::initializer_list<std::size_t> stages);

// Decides for every open tile, all of whose halves have `end` samples, and says how many tiles stay open.
std::size_t judge(const Film& film, std::uint32_t end, double limit, NoiseState& state);

}  // namespace fathom::runtime
