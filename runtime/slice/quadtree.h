// Evaluating a slice by a quadtree: tiles that are solid or empty throughout are filled at once, and in the others
// the program is cut down to what matters there (vm/prune/specialise.h), twice, before its pixels are evaluated.
//
// Source: Duff, "Interval arithmetic and recursive subdivision for implicit functions and constructive solid
// geometry", 1992; Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces", 2020. Tested by:
// tests/runtime/slice/slice_test.cpp
#pragma once

#include <vector>

#include "runtime/slice/slice_frame.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

// As evaluate_slice(), into `field`; false, and nothing done, when the program has too few choices to gain by it.
bool evaluate_by_quadtree(const vm::Code& distance, const Slice& slice, SliceValues wanted, int threads,
                          std::vector<float>& field);

}  // namespace fathom::runtime
