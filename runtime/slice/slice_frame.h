// The frame of a slice: which rectangle of which plane it shows, in how many pixels, and which values are wanted
// there. Planes lie across one of the axes.
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

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "compiler/geometry/box.h"

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

}  // namespace fathom::runtime
