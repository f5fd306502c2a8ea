// Images of the field on a plane across one of the axes: where the field is solid, or how far the surface is.
// Tested by: tests/runtime/slice/slice_test.cpp
#pragma once

#include <vector>

#include "runtime/image/image.h"
#include "runtime/slice/slice_frame.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

// Returns f at the pixels' centres in float32, [y][x], the same for any number of threads. The code is in
// runtime/slice/quadtree.cpp.
std::vector<float> evaluate_slice(const vm::VerifiedProgram& distance, const Slice& slice, int threads,
                                  SliceValues wanted = SliceValues::Exact);

// Returns an image that is white where the value is negative and black elsewhere, without shades between.
ByteImage sign_image(const std::vector<float>& field, int width, int height);

// Returns the step between the bands of distance_image(): 1, 2 or 5 times a power of ten, whichever is nearest to a
// tenth of `length`.
double band_step(double length);

// Returns an image that is blue inside and orange outside, fainter with the distance. The line of value 0 is black. A
// thin line at every multiple of `step` has the hue of its side. NaN is magenta.
ByteImage distance_image(const std::vector<float>& field, int width, int height, double step);

}  // namespace fathom::runtime
