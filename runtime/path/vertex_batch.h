// Vertices of paths: places where rays met surfaces. The stages of the integrator fill a batch of vertices one
// quantity after the other.
//
// A batch is a structure of arrays: the stages that run in lanes (scatter_lanes.h) load a quantity of many vertices
// with one instruction.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "runtime/light/light.h"
#include "runtime/light/light_sample_context.h"
#include "runtime/material/bsdf.h"
#include "runtime/material/material.h"
#include "runtime/path/medium_state.h"
#include "runtime/path/path_state.h"
#include "runtime/path/surface.h"
#include "runtime/sampling/sampler_lanes.h"

namespace fathom::runtime {

// Number of vertices that a stage works on at once: they fit the processor's first cache.
inline constexpr std::size_t kVertexBatch = 64;
static_assert(kVertexBatch <= SamplerRows::kCapacity);

// One quantity of the vertices, [vertex].
template <class T>
using VertexRow = std::array<T, kVertexBatch>;

// The coordinates of one vector of the vertices, each [vertex].
template <class T>
struct VertexRows3 {
  alignas(64) VertexRow<T> x, y, z;

  glm::vec<3, T> operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, glm::vec<3, T> v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

// A place on a surface, with its material and the media on both sides.
struct SurfaceInteraction {
  const Hit* hit;
  const SurfacePoint* point;
  MediumState* medium;            // of the ray that hit the surface
  const MaterialPoint* material;  // VertexBatch::own_material, or a material that is the same everywhere
  // The medium of a ray that goes through the surface: VertexBatch::own_beyond, or `medium` if the material lets none
  // through.
  const MediumState* medium_beyond;
  bool inside;  // the ray comes out of the solid whose surface this is
};

struct VertexBatch {
  std::size_t count = 0;
  VertexRow<std::uint32_t> id;
  VertexRow<PathState*> path;
  VertexRow<double> t;     // distance along the ray
  VertexRow<bool> active;  // false: the later stages pass over the vertex
  VertexRow<SurfaceInteraction> surface;
  // Large and rarely used, hence apart from `surface`.
  VertexRow<MaterialPoint> own_material;
  VertexRow<MediumState> own_beyond;

  // Scattering. A diffuse or emissive material has no `bsdf`: its BSDF is `albedo` / pi.
  VertexRow<bool> has_bsdf;
  VertexRow<std::optional<Bsdf>> bsdf;
  SamplerRows samplers;
  VertexRows3<float> normal, albedo;
  alignas(64) VertexRow<float> u, v, lobe, roulette;  // random numbers in [0,1)
  // The sampled direction (BsdfSample).
  VertexRows3<float> wi, weight;
  alignas(64) VertexRow<float> pdf;
  VertexRow<float> eta_scale;
  VertexRow<bool> is_transmission, is_null;

  // Direct light.
  bool has_lights = false;                      // the scene has lights
  VertexRow<LightSampleContext> light_context;  // only if has_lights
  VertexRow<LightSample> light_sample;
  VertexRow<bool> has_shadow_ray;  // true: `shadow_ray` is to be traced before the path goes on
  VertexRow<ShadowRay> shadow_ray;
};

// Calls use(i) for every active vertex.
template <class Use>
void for_each_active(const VertexBatch& batch, const Use& use) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (batch.active[i]) use(i);
  }
}

}  // namespace fathom::runtime
