// Motion blur by stratified shutter times. Everything in a scene may move, so a pixel's samples are split into runs,
// and each run sees the scene at one moment. A run's moment lies anywhere in the run's share of the shutter time, so
// the mean over the runs estimates the light of the whole time: stratified sampling in one dimension (Cook, Porter,
// Carpenter, "Distributed Ray Tracing", 1984).
//
// Runs have even lengths. The denoiser compares samples with even numbers and samples with odd numbers, and even
// lengths give both the same moments.
//
// Tested by: tests/runtime/sampling/shutter_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/base/coverage.h"
#include "runtime/sampling/sampler.h"

namespace fathom::runtime {

inline constexpr int kDefaultShutterTimes = 16;

// Returns the seed of a frame's random numbers. Each frame has its own, because noise that stands still is visible.
// Frame 0 has `seed` itself.
constexpr std::uint64_t frame_seed(std::uint64_t seed, int frame) {
  if (frame == 0) return seed;
  return mix64(mix64(seed + kGoldenGamma) + kGoldenGamma * static_cast<std::uint64_t>(frame));
}

struct ShutterInterval {
  SampleRange samples;
  double time;  // moment of the scene, as a share of the time that the shutter is open, in [0,1)
};

// Returns at most `times` runs, in order, with `spp` samples together. Runs are equally long if their number divides
// spp/2. Otherwise their lengths differ by two samples, and their shares of the time accordingly. `seed` is that of
// all frames.
std::vector<ShutterInterval> shutter_intervals(int spp, int times, std::uint64_t seed, int frame);

}  // namespace fathom::runtime
