// The vertices of paths: places where rays met surfaces. The stages of the integrator fill a batch of vertices one
// quantity after the other.
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/light/light.h"
#include "runtime/light/light_sample_context.h"
#include "runtime/material/bsdf.h"
#include "runtime/material/material.h"
#include "runtime/path/medium_state.h"
#include "runtime/path/path_state.h"
#include "runtime/path/surface.h"

namespace fathom::runtime {

// Number of vertices that a stage works on at once: they fit the processor's first cache.
inline constexpr std::size_t kVertexBatch = 16;

// A place on a surface, with its material and the media on both sides.
struct SurfaceInteraction {
  const Hit* hit;
  const SurfacePoint* point;
  MediumState medium;             // of the ray that hit the surface
  const MaterialPoint* material;  // `own_material`, or a material that is the same everywhere
  MaterialPoint own_material;
  bool inside;                // the ray comes out of the solid whose surface this is
  MediumState medium_beyond;  // of a ray that goes through the surface
};

struct PathVertex {
  std::uint32_t id;
  PathState* path;
  double t;     // distance along the ray
  bool active;  // false: the later stages pass over the vertex
  SurfaceInteraction surface;
  std::optional<Bsdf> bsdf;
  BsdfSample bsdf_sample;
  float roulette;            // random number in [0,1) for Russian roulette
  LightSampleContext light_context;  // only in a scene with lights
  LightSample light_sample;
  std::optional<ShadowRay> shadow_ray;  // to be traced before the path goes on
};

}  // namespace fathom::runtime
