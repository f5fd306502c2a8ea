// Lanes (lane_rows.h), and how they move on by one evaluation of the field: the renderer's way (tiered-inl.h), and
// those it is compared with (traced-inl.h).
//
// Not a public header: march.h is. Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/march/lane_rows.h"

namespace fathom::runtime {

// Floats in a register of the instruction set in use.
std::size_t register_lanes();

using LaneNumbers = std::array<std::uint16_t, Lanes<float>::kCapacity>;

// What the field says of the lanes' x, y, z: its value and, of the tiered method alone, where it is known, how far
// around the solid is convex (vm::evaluate_convex), else null. Read past the last lane up to a whole register.
template <class S>
struct Samples {
  const S* f;
  const S* convex;
};

// Moves `count` lanes on. Writes their verdicts, and to `ended` the numbers of those that go no further, upwards; how
// many these are is what it returns. May write to lanes past `count` up to a whole register.
std::size_t advance(Lanes<float>& lanes, std::size_t count, Samples<float> at, const LaneRules<float>& rules,
                    LaneNumbers& ended);
std::size_t advance(Lanes<double>& lanes, std::size_t count, Samples<double> at, const LaneRules<double>& rules,
                    LaneNumbers& ended);

}  // namespace fathom::runtime
