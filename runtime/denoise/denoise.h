// The denoiser: estimates the image that many more samples would give, from each pixel's neighbourhood.
//
// Rousselle, Manzi, Zwicker, "Robust Denoising using Feature and Color Information", Pacific Graphics 2013: means
// over a window, weighted by how similar pixels are in colour, in features, or in both. Each pixel takes the mean
// with the least error of the three, which is estimated without knowing the truth (runtime/denoise/nl_means.h). A
// build with Open Image Denoise uses that library instead (FATHOM_OIDN).
//
// Tested by: tests/runtime/denoise/denoise_test.cpp
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "runtime/film/film.h"

namespace fathom::runtime {

// All [y][x] or [y][x][component], y downwards, each of one size. A pixel that is not finite is made up by its
// neighbours.
struct DenoiseInput {
  int width = 0, height = 0;
  // Mean radiance, linear sRGB, of two halves of each pixel's samples. The halves have the image in common and differ
  // in noise. The filter keeps them apart, so that noise cannot choose its own weights.
  std::span<const float> first, second;
  // Features of the first hit, means over the samples and nearly free of noise.
  std::span<const float> albedo;  // [0,1]; 1 for misses
  std::span<const float> normal;  // not normalised; 0 for misses
  std::span<const float> depth;   // scene units; 0 for misses
};

// Memory of the denoiser's work, bytes per pixel.
inline constexpr double kDenoiserBytes = 128;

// Returns denoised radiance, [y][x][rgb]. The bits do not depend on `threads`. With Open Image Denoise they may
// depend on the machine.
std::vector<float> denoise(const DenoiseInput& input, int threads);

// Gives the film denoised radiance (Film::set_denoised). The film must keep FilmLayers::first_hit and ::halves, with
// at least two samples per pixel. Returns false, with the film unchanged, soon after `is_cancelled` has returned
// true; any thread calls it. Open Image Denoise cannot be cancelled.
bool denoise(Film& film, int threads, const std::function<bool()>& is_cancelled = nullptr);

}  // namespace fathom::runtime
