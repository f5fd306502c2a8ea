// Camera rays of many points of the image at once: in lanes for a pinhole camera in perspective, bit for bit those of
// Camera::ray().
// Tested by: tests/runtime/sampling/camera_test.cpp
#pragma once

#include <cstddef>

#include "runtime/sampling/camera.h"

namespace fathom::runtime {

// Points of the image in pixels, [ray], and the unit directions of the rays through them, [axis][ray]. Kernels write
// whole registers.
struct PinholeRows {
  static constexpr std::size_t kCapacity = 64;
  alignas(64) double x[kCapacity] = {}, y[kCapacity] = {};
  alignas(64) double direction[3][kCapacity];
};

// Sets the directions of the first `count` rays. Requires is_pinhole(camera). The rays begin at camera.position().
void set_pinhole_directions(const Camera& camera, std::size_t count, PinholeRows& rows);

// True if the camera is in perspective and has no lens.
inline bool is_pinhole(const Camera& camera) {
  return camera.projection() == compiler::Camera::Projection::Perspective && !camera.has_lens();
}

}  // namespace fathom::runtime
