// Random numbers without a state: each is a function of (seed, pixel, sample, dimension) alone, so that neither the
// order of the work nor the number of threads can change an image.
//
//     const PixelKey pixel(plan, x, y);       // once for many samples
//     Sampler sampler(pixel, sample);
//     glm::vec2 place = sampler.next2();      // pair 0: the point in the pixel
//     glm::vec2 lens = sampler.next2();       // pair 1: the point on the lens
//     sampler.start_bounce(0);                // every bounce has pairs of its own
//
// Dimensions come in pairs, and a pair's two numbers are a point of a square. next2() takes a pair. next() takes the
// first half of a pair, and the other half is not used. The n-th request of a bounce therefore has the same pair in
// all samples.
//
// - independent: SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014:
//   mix64variant13, golden gamma) of key and count. Samples are independent, as hypothesis tests need them.
// - sobol: every pair takes the points of Sobol's sequence, (0,2) in base 2. Owen's nested uniform scrambling, made
//   out of a hash, gives their order and their digits: Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4),
//   2020. Any 2^k samples from a multiple of 2^k on lie one in each of the 2^k equal rectangles of every shape.
// - blue: one such sequence for the whole image. The pixels in Z order, scrambled in base 4, take 2^k points each.
//   Squares of pixels therefore have well spread samples, too, and errors cancel among neighbours: Ahmed and Wonka,
//   "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", 2020.
//
// Tested by: tests/runtime/sampling/sampler_test.cpp
#pragma once

#include <bit>
#include <cstdint>
#include <glm/vec2.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

using compiler::SamplerKind;

inline constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15u;

constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// Returns the bits in reverse order.
constexpr std::uint64_t reversed(std::uint64_t v) {
  v = (v >> 1 & 0x5555555555555555u) | (v & 0x5555555555555555u) << 1;
  v = (v >> 2 & 0x3333333333333333u) | (v & 0x3333333333333333u) << 2;
  v = (v >> 4 & 0x0f0f0f0f0f0f0f0fu) | (v & 0x0f0f0f0f0f0f0f0fu) << 4;
  return __builtin_bswap64(v);
}
constexpr std::uint32_t reversed(std::uint32_t v) {
  v = (v >> 1 & 0x55555555u) | (v & 0x55555555u) << 1;
  v = (v >> 2 & 0x33333333u) | (v & 0x33333333u) << 2;
  v = (v >> 4 & 0x0f0f0f0fu) | (v & 0x0f0f0f0fu) << 4;
  return __builtin_bswap32(v);
}

// Owen's scrambling of a fraction in base 2 whose first digit is the lowest bit: a hash of the seed and the lower
// bits decides if a bit is flipped. Laine and Karras, "Stratified Sampling for Stochastic Transparency", 2011, with
// the multipliers of Vegdahl, "Building a Better LK Hash", 2021.
constexpr std::uint32_t owen_scrambled(std::uint32_t v, std::uint32_t seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= seed >> 16 | 1;
  v ^= v * 0x05526c56u;
  return v ^ v * 0x53a22864u;
}

// Returns the second coordinate of the index-th point of Sobol's sequence, its first digit in the lowest bit. The
// first coordinate, so written, is the index itself. The matrix is Pascal's triangle modulo 2: digit r is the sum of
// the index's bits c with r a subset of c (Lucas' theorem), summed over supersets one bit of r at a time.
constexpr std::uint32_t sobol_second(std::uint32_t index) {
  index ^= index >> 1 & 0x55555555u;
  index ^= index >> 2 & 0x33333333u;
  index ^= index >> 4 & 0x0f0f0f0fu;
  index ^= index >> 8 & 0x00ff00ffu;
  return index ^ index >> 16;
}

// Spreads bits 0 to 15 to the even places.
constexpr std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 8) & 0x00ff00ffu;
  v = (v | v << 4) & 0x0f0f0f0fu;
  v = (v | v << 2) & 0x33333333u;
  return (v | v << 1) & 0x55555555u;
}

// Settings that all samples of an image share.
struct SamplePlan {
  SamplerKind kind = SamplerKind::Independent;
  std::uint64_t seed = 0;
  int spp = 1;  // samples per pixel; `blue` divides its sequence by them. More may be drawn.
};

// The sampler's state that all samples of a pixel share.
class PixelKey {
 public:
  PixelKey() = default;
  PixelKey(const SamplePlan& plan, std::uint32_t x, std::uint32_t y) : kind_(plan.kind) {
    const std::uint64_t seed = mix64(plan.seed + kGoldenGamma);
    if (plan.kind != SamplerKind::Blue) {
      key_ = mix64(seed ^ (static_cast<std::uint64_t>(y) << 32 | x));
      return;
    }
    // An index of 32 bits holds the pixel's digits and the sample's. Pixels that differ in higher digits have
    // different sequences.
    const std::uint32_t place = spread_bits(y) << 1 | spread_bits(x);
    sample_bits_ = std::bit_width(static_cast<std::uint32_t>(plan.spp - 1));
    pixel_bits_ = (32 - sample_bits_) & ~1;
    key_ = mix64(seed + (static_cast<std::uint64_t>(place) >> pixel_bits_));
    pixel_index_ = reversed(static_cast<std::uint64_t>(place) << (64 - pixel_bits_)) & 0xffffffffu;
  }

 private:
  friend class Sampler;
  SamplerKind kind_ = SamplerKind::Independent;
  std::uint64_t key_ = 0;
  // Pixel's part of the index in the sequence, written backwards: the pixel's first digit is lowest.
  std::uint32_t pixel_index_ = 0;
  int pixel_bits_ = 0, sample_bits_ = 32;
};

class Sampler {
 public:
  // Number of pairs that a bounce may draw. Another pair would be the next bounce's.
  static constexpr int kPairsPerBounce = 16;

  Sampler() = default;
  Sampler(const PixelKey& pixel, std::uint32_t sample) : kind_(pixel.kind_), key_(pixel.key_) {
    if (kind_ == SamplerKind::Independent) {
      key_ = mix64(key_ + kGoldenGamma * (sample + 1ull));
      return;
    }
    const std::uint64_t index = static_cast<std::uint64_t>(sample);
    // Samples beyond the planned number come from another sequence.
    if (index >> pixel.sample_bits_ != 0) key_ = mix64(key_ + kGoldenGamma * (index >> pixel.sample_bits_));
    const std::uint64_t backwards = reversed(index << 32 << (32 - pixel.sample_bits_));
    index_ = static_cast<std::uint32_t>(backwards << pixel.pixel_bits_) | pixel.pixel_index_;
    unused_bits_ = static_cast<std::uint8_t>(32 - pixel.pixel_bits_ - pixel.sample_bits_);
    pixel_bits_ = static_cast<std::uint8_t>(pixel.pixel_bits_);
  }
  // Makes a sampler of the kind `independent`.
  Sampler(std::uint64_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t sample)
      : Sampler(PixelKey({SamplerKind::Independent, seed, 1}, x, y), sample) {}

  // Assigns the numbers drawn next to the bounce, counted from 0.
  void start_bounce(int bounce) { dimension_ = bounce_dimension(kind_, bounce); }

  // Returns a number in [0,1), a multiple of 2^-24.
  float next() {
    if (kind_ == SamplerKind::Independent) return next_independent();
    const std::uint64_t hash = pair_hash();
    return to_unit(reversed(owen_scrambled(shuffled_index(hash), first_seed(hash))));
  }
  glm::vec2 next2() {
    if (kind_ == SamplerKind::Independent) {
      const float a = next_independent();
      return {a, next_independent()};
    }
    const std::uint64_t hash = pair_hash();
    const std::uint32_t index = shuffled_index(hash);
    const std::uint32_t a = owen_scrambled(index, first_seed(hash));
    const std::uint32_t b = owen_scrambled(sobol_second(index), second_seed(hash));
    const std::uint64_t both = reversed(static_cast<std::uint64_t>(a) << 32 | b);
    return {to_unit(static_cast<std::uint32_t>(both)), to_unit(static_cast<std::uint32_t>(both >> 32))};
  }

 private:
  friend class SamplerRows;

  // Returns the value of dimension_ at the beginning of a bounce.
  static std::uint32_t bounce_dimension(SamplerKind kind, int bounce) {
    const std::uint32_t pairs = 2 + static_cast<std::uint32_t>(bounce) * kPairsPerBounce;
    return kind == SamplerKind::Independent ? 2 * pairs : pairs;
  }
  static float to_unit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

  float next_independent() { return static_cast<float>(mix64(key_ + kGoldenGamma * ++dimension_) >> 40) * 0x1p-24f; }

  // Returns 64 random bits for the next pair. The seeds are made of these bits.
  std::uint64_t pair_hash() { return mix64(key_ + kGoldenGamma * ++dimension_); }
  static std::uint32_t first_seed(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> 32); }
  static std::uint32_t second_seed(std::uint64_t hash) {
    return static_cast<std::uint32_t>(hash * 0xd1342543de82ef95u >> 32);
  }

  // Returns the sample's index in the pair's sequence.
  std::uint32_t shuffled_index(std::uint64_t hash) const {
    const auto seed = static_cast<std::uint32_t>(hash);
    const std::uint32_t digits = kind_ == SamplerKind::Blue ? rotated(index_, seed) : index_;
    return reversed(owen_scrambled(digits, seed)) >> unused_bits_;
  }

  // Owen's scrambling in base 4 permutes the four values of each digit by a hash of the digits before it. The 24
  // permutations are those that base 2 can make after one of three rotations of the values 1, 2, 3: with a for the
  // first bit and b for the second, (a, b) stays or becomes (b, a+b) or (a+b, a). This function does the rotations.
  std::uint32_t rotated(std::uint32_t v, std::uint32_t seed) const {
    const std::uint32_t pixels = static_cast<std::uint32_t>((1ull << pixel_bits_) - 1) & 0x55555555u;
    // Bits of lower digits only: products carry upwards, once with an odd factor and once with an even one.
    const std::uint32_t spread = (v + ~seed) * 0x9e3779b1u, hash = (spread ^ spread * 0x3d20adeau) << 2;
    const std::uint32_t once = hash & ~(hash >> 1) & pixels, twice = ~hash & hash >> 1 & pixels;
    const std::uint32_t a = v & 0x55555555u, b = v >> 1 & 0x55555555u;
    const std::uint32_t first = a ^ ((a ^ b) & once) ^ (b & twice);
    const std::uint32_t second = b ^ (a & once) ^ ((a ^ b) & twice);
    return first | second << 1;
  }

  SamplerKind kind_ = SamplerKind::Independent;
  std::uint8_t unused_bits_ = 0, pixel_bits_ = 0;
  std::uint32_t index_ = 0;  // of the sample in the sequence, written backwards
  std::uint32_t dimension_ = 0;  // number of pairs drawn; for `independent`, of numbers
  std::uint64_t key_ = 0;
};

}  // namespace fathom::runtime
