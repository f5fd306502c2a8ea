// Normals, offsets and clear distances of surface points, in lanes. Not a public header: surface.h is.
// Tested by: tests/runtime/path/surface_test.cpp
#pragma once

#include <cstddef>

#include "runtime/field/field.h"

namespace fathom::runtime {

inline constexpr std::size_t kSurfaceBatch = 256;

// Hits and the field there, [hit], in single precision. Kernels write whole registers.
struct SurfaceRows {
  alignas(64) float position[3][kSurfaceBatch], size[kSurfaceBatch];  // size: max norm of the position, at least 1
  alignas(64) float gradient[3][kSurfaceBatch], convex[kSurfaceBatch];
  alignas(64) float wo[3][kSurfaceBatch], side[kSurfaceBatch], width[kSurfaceBatch];
  // 1 / Lipschitz constant of the field near the hit; 0 if it has no bound there.
  alignas(64) float inverse_slope[kSurfaceBatch];
  // Results: as of SurfacePoint.
  alignas(64) float normal[3][kSurfaceBatch], steepness[kSurfaceBatch];
  alignas(64) float offset[kSurfaceBatch], clear[kSurfaceBatch];
};

// Distance from the surface at which a new ray starts, in d_f: float cannot mistake the sides there. The part of d_f
// that comes from cancellation is a loose bound, of which twice is enough.
inline constexpr float kOffsetErrors = 16, kMagnitudeErrors = 2;
// The field may be flatter than its Lipschitz constant, and d_f then a longer way. In a field with bounds in cells
// the distance is so many times longer, at most this factor.
inline constexpr float kMaxFlatness = 16;
// Maximum of that distance, in bands: 0.3 % of the subject's size. Rays that start closer than d_f are marched in
// double.
inline constexpr float kMaxOffset = 32;

// Sets the results of the first `count` hits.
void set_surface_geometry(const Field& field, std::size_t count, SurfaceRows& rows);

}  // namespace fathom::runtime
