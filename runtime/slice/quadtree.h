// Evaluates a slice by a quadtree. If only signs are needed, tiles that are solid or empty throughout are filled at
// once. In other tiles each level prunes the program (vm/prune/specialise.h), and then the pixels are evaluated.
//
// Source: Duff, "Interval arithmetic and recursive subdivision for implicit functions and constructive solid
// geometry", 1992; Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces", 2020. Tested by:
// tests/runtime/slice/slice_test.cpp
#pragma once

#include <vector>

#include "runtime/slice/slice_frame.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

// Like evaluate_slice(), into `field`. Returns false and does nothing when the program has too few choices to gain.
bool evaluate_by_quadtree(const vm::Code& distance, const Slice& slice, SliceValues wanted, int threads,
                          std::vector<float>& field);

}  // namespace fathom::runtime
