// Lanes (lane_rows.h), and their advance by one evaluation of the field: by the renderer's own method (tiered-inl.h),
// or by a baseline method (sphere_tracing-inl.h).
//
// Not a public header: march.h is. Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/march/lane_rows.h"

namespace fathom::runtime {

// Returns the number of floats in a register of the instruction set in use.
std::size_t register_lanes();

using LaneNumbers = std::array<std::uint16_t, Lanes<float>::kCapacity>;

// The field at the lanes' points: its value and, if the tiered method runs on a field that knows it, the convexity
// radius (vm::evaluate_convex), else null. advance() reads past the last lane up to a whole register.
template <class S>
struct FieldSamples {
  const S* f;
  const S* convexity;
};

// Advance `count` lanes and write their verdicts. The numbers of the lanes that have ended go to `ended`, in
// ascending order, and their count is returned. May write to lanes past `count` up to a whole register.
std::size_t advance(Lanes<float>& lanes, std::size_t count, FieldSamples<float> at, const LaneRules<float>& rules,
                    LaneNumbers& ended);
std::size_t advance(Lanes<double>& lanes, std::size_t count, FieldSamples<double> at, const LaneRules<double>& rules,
                    LaneNumbers& ended);

}  // namespace fathom::runtime
