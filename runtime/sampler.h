// Random numbers without a state: each is a function of (seed, pixel, sample, dimension) alone, so that neither the
// order of the work nor the number of threads can change a picture.
//
// The key is hashed with, and the dimensions are drawn by, SplitMix64: Steele, Lea, Flood, "Fast Splittable
// Pseudorandom Number Generators", OOPSLA 2014 (mix64variant13, golden gamma).
//
//     Sampler sampler(seed, x, y, sample);
//     float u = sampler.next();
//
// Not stratified: samples are independent, so the error falls with the square root of their number.
// Tested by: tests/runtime/sampler_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

namespace fathom::runtime {

inline constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15u;

constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

class Sampler {
 public:
  Sampler() = default;
  Sampler(std::uint64_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t sample)
      : Sampler(pixel_key(seed, x, y), sample) {}

  // What the samples of a pixel have in common, for who draws many.
  static std::uint64_t pixel_key(std::uint64_t seed, std::uint32_t x, std::uint32_t y) {
    return mix64(mix64(seed + kGoldenGamma) ^ (static_cast<std::uint64_t>(y) << 32 | x));
  }
  Sampler(std::uint64_t pixel_key, std::uint32_t sample) : key_(mix64(pixel_key + kGoldenGamma * (sample + 1ull))) {}

  // The next dimension, in [0,1): a multiple of 2^-24.
  float next() {
    key_ += kGoldenGamma;
    return static_cast<float>(mix64(key_) >> 40) * 0x1p-24f;
  }
  // The next two dimensions, in order.
  glm::vec2 next2() {
    const float a = next();
    return {a, next()};
  }

 private:
  std::uint64_t key_ = 0;
};

}  // namespace fathom::runtime
