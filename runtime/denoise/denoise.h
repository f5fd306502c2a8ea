// The denoiser: what a picture of few samples would be with many more, as far as its neighbourhood tells.
//
// Rousselle, Manzi, Zwicker, "Robust Denoising using Feature and Color Information", Pacific Graphics 2013: means
// over a window, weighted by how alike pixels are in colour, in what is seen there, or in both; each pixel takes the
// one of the three with the least error, which is estimated without knowing the truth (runtime/denoise/nl_means.h).
// Built where Open Image Denoise is installed, that does the work instead (FATHOM_OIDN).
//
// Tested by: tests/runtime/denoise/denoise_test.cpp
#pragma once

#include <span>
#include <vector>

#include "runtime/film/film.h"

namespace fathom::runtime {

// All [y][x] or [y][x][component], y downwards, each of one size. What is not finite is made up from its neighbours.
struct DenoiseInput {
  int width = 0, height = 0;
  // Mean radiance, linear sRGB, of two halves of each pixel's samples: what they have in common is the picture, in
  // what they differ is noise. Not looked at together, so that noise cannot choose its own weights.
  std::span<const float> first, second;
  // Of the first surface met, means over the samples and as good as free of noise.
  std::span<const float> albedo;  // [0,1]; 1 where nothing was met
  std::span<const float> normal;  // not normalised; 0 where nothing was met
  std::span<const float> depth;   // scene units; 0 where nothing was met
};

// Denoised radiance, [y][x][rgb]. The bits do not depend on `threads`; with Open Image Denoise they may depend on the
// machine.
std::vector<float> denoise(const DenoiseInput& input, int threads);

// Gives the film denoised radiance (Film::set_denoised); it must keep FilmLayers::first_hit and ::halves, with two
// samples a pixel or more.
void denoise(Film& film, int threads);

}  // namespace fathom::runtime
