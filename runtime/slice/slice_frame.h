// The frame of a slice: the rectangle it shows of a plane, the number of pixels, and the kind of values needed.
// Planes lie across one of the axes.
//
// The views are right-handed, with the third axis towards the eye:
//
//     across  right  up
//     z       +x     +y    from the front
//     y       +x     -z    from above
//     x       -z     +y    from the right
//
// Tested by: tests/runtime/slice/slice_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "compiler/geometry/box.h"

namespace fathom::runtime {

enum class Axis { X, Y, Z };

// A rectangle of pixels on the plane where coordinate `axis` is `at`.
struct Slice {
  Axis axis = Axis::Z;
  double at = 0;              // scene units
  glm::dvec2 lo{0}, hi{0};    // corners in the plane's axes: (x, y) across z, (x, z) across y, (z, y) across x
  int width = 1, height = 1;  // pixels

  // Returns the centre of pixel (column, row), with row 0 at the top.
  glm::dvec3 point(int column, int row) const;
};

// Returns the point's two coordinates in a plane across the axis, in the order of Slice::lo.
glm::dvec2 on_plane(Axis axis, glm::dvec3 point);

// Returns the slice of `box`, a tenth larger, widened until the pixels are square. An infinite side ends at 2 from
// the origin, or has a length of 4.
Slice frame_slice(const compiler::Box& box, Axis axis, double at, int width, int height);

// Kind of values needed of the field: exact values, or any numbers of the same sign.
enum class SliceValues { Exact, Sign };

}  // namespace fathom::runtime
