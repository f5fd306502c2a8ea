// Pictures of the field on a plane across one of the axes: where it is solid, or how far the surface is.
// Tested by: tests/runtime/slice/slice_test.cpp
#pragma once

#include <vector>

#include "runtime/image/image.h"
#include "runtime/slice/slice_frame.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

// f at the pixels' centres in float32, [y][x], the same for any number of threads. Of programs that can be cut the
// picture is a quadtree (runtime/slice/quadtree.h), of others it is cut into rows.
std::vector<float> evaluate_slice(const vm::VerifiedProgram& distance, const Slice& slice, int threads,
                                  SliceValues wanted = SliceValues::Exact);

// White where the value is negative, black elsewhere, nothing between.
Picture sign_picture(const std::vector<float>& field, int width, int height);

// How far the bands of distance_picture() are apart: the number 1, 2 or 5 times a power of ten that is nearest to a
// tenth of `length`.
double band_step(double length);

// Blue inside, orange outside, fainter with the distance; a black line where the value is 0 and a thin one at every
// multiple of `step`, in the hue of its side; magenta where the value is not a number.
Picture distance_picture(const std::vector<float>& field, int width, int height, double step);

}  // namespace fathom::runtime
