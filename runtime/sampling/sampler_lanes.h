// Many samplers at once: the numbers that they draw, in lanes, bit for bit those of Sampler.
//
//     SamplerRows samplers;
//     for (i < count) samplers.set(i, sampler[i]);
//     samplers.draw_pairs(count, u, v);          // what Sampler::next2() returns, u[i] and v[i]
//     samplers.take_pairs(count);                // the next draw is of other numbers
//
// Tested by: tests/runtime/sampling/sampler_lanes_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/sampling/sampler.h"

namespace fathom::runtime {

// Samplers of one plan, [sampler]. Draws write whole registers: rows of numbers have kCapacity elements.
class SamplerRows {
 public:
  static constexpr std::size_t kCapacity = 64;

  // Makes the i-th sampler a copy of `sampler`.
  void set(std::size_t i, const Sampler& sampler) {
    kind_ = sampler.kind_;
    unused_bits_ = sampler.unused_bits_;
    pixel_bits_ = sampler.pixel_bits_;
    key_[i] = sampler.key_;
    index_[i] = sampler.index_;
    dimension_[i] = sampler.dimension_;
  }
  // Assigns the numbers drawn next to the bounce, as Sampler::start_bounce() does.
  void start_bounce(std::size_t i, int bounce) { dimension_[i] = Sampler::bounce_dimension(kind_, bounce); }

  // Write the next pair, or the next number, of each of the first `count` samplers, without taking it: the next draw
  // writes the same again.
  void draw_pairs(std::size_t count, float* u, float* v) const;
  void draw(std::size_t count, float* u) const;

  // Take the pairs, or the numbers, that were drawn.
  void take_pairs(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) dimension_[i] += kind_ == SamplerKind::Independent ? 2 : 1;
  }
  void take_numbers(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) take_number(i);
  }
  void take_number(std::size_t i) { ++dimension_[i]; }

 private:
  friend struct SamplerKernel;
  SamplerKind kind_ = SamplerKind::Independent;
  std::uint8_t unused_bits_ = 0, pixel_bits_ = 0;
  alignas(64) std::uint64_t key_[kCapacity];
  alignas(64) std::uint32_t index_[kCapacity];
  alignas(64) std::uint32_t dimension_[kCapacity];
};

}  // namespace fathom::runtime
