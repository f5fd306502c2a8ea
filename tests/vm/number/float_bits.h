// Helpers for the tests of the float evaluators: clouds of points, bits of results, and a guard that restores the
// instruction set.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "vm/interpret/evaluate.h"

namespace fathom::test {

// Points as three arrays, one per coordinate.
struct Cloud {
  std::vector<float> x, y, z;

  void add(float px, float py, float pz) { x.push_back(px), y.push_back(py), z.push_back(pz); }
  std::size_t size() const { return x.size(); }
  vm::Points from(std::size_t first) const { return {x.data() + first, y.data() + first, z.data() + first}; }
};

// Bits of a float. All NaNs count as equal, since IEEE 754 leaves their sign and payload to the processor.
inline std::uint32_t bits_of(float f) {
  return std::bit_cast<std::uint32_t>(std::isnan(f) ? std::numeric_limits<float>::quiet_NaN() : f);
}

inline std::vector<std::uint32_t> distance_bits(const vm::VerifiedProgram& program, vm::Points points,
                                                std::size_t count, vm::Workspace& workspace) {
  std::vector<float> d(count);
  vm::evaluate_distance(program, points, count, d.data(), workspace);
  std::vector<std::uint32_t> bits(count);
  std::transform(d.begin(), d.end(), bits.begin(), bits_of);
  return bits;
}

// Restores the instruction set at the end of a test that forces others.
struct IsaGuard {
  std::string before{vm::isa_name()};
  ~IsaGuard() { vm::force_isa(before); }
};

}  // namespace fathom::test
