// Pictures of the field on a plane across one of the axes: where it is solid, or how far the surface is.
//
// The views are right-handed, the third axis towards the eye:
//
//     across  right  up
//     z       +x     +y    from the front
//     y       +x     -z    from above
//     x       -z     +y    from the right
//
// Tested by: tests/runtime/slice/slice_test.cpp
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "compiler/box.h"
#include "runtime/image/image.h"
#include "vm/verify.h"

namespace fathom::runtime {

enum class Axis { X, Y, Z };

// A rectangle of pixels on the plane where coordinate `axis` is `at`.
struct Slice {
  Axis axis = Axis::Z;
  double at = 0;              // scene units
  glm::dvec2 lo{0}, hi{0};    // corners by the plane's axes: (x, y) across z, (x, z) across y, (z, y) across x
  int width = 1, height = 1;  // pixels

  // The centre of pixel (column, row), row 0 at the top.
  glm::dvec3 point(int column, int row) const;
};

// The two of the point's coordinates that a plane across the axis has, in the order of Slice::lo.
glm::dvec2 on_plane(Axis axis, glm::dvec3 point);

// The slice of `box`, a tenth larger, widened until the pixels are square. A side without an end is taken to 2 from
// the origin, or to a length of 4.
Slice frame_slice(const compiler::Box& box, Axis axis, double at, int width, int height);

// What is wanted of the field: its values, or no more than numbers of the same sign.
enum class SliceValues { Exact, Sign };

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
