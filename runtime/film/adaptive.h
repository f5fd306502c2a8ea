// Adaptive sampling without bias: more samples where the picture is noisy.
//
// Stage 1 gives every pixel first_samples() samples. Stage 2 shares out the rest by what stage 1 shows of the errors.
// A pixel is w * (mean of stage 1) + (1 - w) * (mean of stage 2) with w = first_share(), fixed beforehand: whatever
// number of samples stage 1 leads to, the mean of stage 2 is expected to be the true one. (One mean over all samples
// is not: pixels that miss a light in stage 1 get few samples and stay dark. Kirk and Arvo, "Unbiased Sampling
// Techniques for Image Synthesis", 1991.)
//
//     {sampler, seed, first_samples(spp)}                     // stage 1: of every pixel all
//     more = second_samples(estimates_of(film), width, height, spp);
//     {sampler, second_seed(seed), spp - first_samples(spp)}  // stage 2: samples [0, more[pixel])
//
// Stage 2 needs numbers that know nothing of stage 1's: in one sequence later points avoid earlier ones, and bias is
// back.
//
// Tested by: tests/runtime/film/adaptive_test.cpp
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/film/film.h"

namespace fathom::runtime {

// What stage 1 says of a pixel: of its samples' luminance the mean, and the variance with n - 1 in the denominator.
struct PixelEstimate {
  double mean = 0, variance = 0;
};

inline constexpr int kLeastAdaptiveSpp = 8;  // below, there is too little to share out

// Samples of stage 1 for a render of `spp` samples a pixel: a quarter, at least 4. spp >= kLeastAdaptiveSpp.
int first_samples(int spp);

// The weight w of stage 1's mean; 1 - w is that of stage 2's.
double first_share(int spp);

// What stage 1 of a film, which keeps `variance`, says of its pixels' luminance, [y][x]; whether there is a stage 2
// makes no difference. The variance is what it would be if the colours of a pixel's samples differed in brightness
// alone: at most too large.
std::vector<PixelEstimate> estimates_of(const Film& film);

std::uint64_t second_seed(std::uint64_t seed);

// Samples of stage 2 for each pixel, [y * width + x] like `estimates`: together width * height *
// (spp - first_samples(spp)), none below 2, so that each has a variance. In proportion to the noise as the eye sees
// it, standard deviation over the root of brightness (Dammertz, Hanika, Keller, Lensch, "A Hierarchical Automatic
// Stopping Condition for Monte Carlo Global Illumination", 2010), which is taken over the neighbours, too, but within
// a quarter and sixteen times of the average: few samples may know nothing of a rare bright path, or too much.
std::vector<int> second_samples(std::span<const PixelEstimate> estimates, int width, int height, int spp);

}  // namespace fathom::runtime
