// The moments that a shutter sees. Everything in a scene may move, so time is sampled by scenes: the samples of a
// pixel are cut into runs, and each run sees the scene of one moment. A run's moment lies anywhere in the run's share
// of the time, so the mean over them is the light of the whole time: stratified sampling in one dimension (Cook,
// Porter, Carpenter, "Distributed Ray Tracing", 1984).
//
// Runs are of even length: the samples with even numbers and those with odd ones, which the denoiser compares, see
// the same moments.
//
// Tested by: tests/runtime/sampling/shutter_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/base/coverage.h"
#include "runtime/sampling/sampler.h"

namespace fathom::runtime {

inline constexpr int kUsualShutterTimes = 16;

// Of a frame's random numbers, by its number: noise that stood still would be seen. Of frame 0 the seed itself.
constexpr std::uint64_t frame_seed(std::uint64_t seed, int frame) {
  if (frame == 0) return seed;
  return mix64(mix64(seed + kGoldenGamma) + kGoldenGamma * static_cast<std::uint64_t>(frame));
}

struct ShutterRun {
  SampleRange samples;
  double time;  // when it sees the scene: a share of the time that the shutter is open, in [0,1)
};

// At most `times` runs, in order, of `spp` samples together; as long as each other where their number divides spp/2,
// else by two samples longer or shorter, with as much more or less of the time. `seed` is that of all frames.
std::vector<ShutterRun> shutter_runs(int spp, int times, std::uint64_t seed, int frame);

}  // namespace fathom::runtime
