// The state of camera paths from one ray to the next. The stages of the integrator read and write it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "runtime/film/film.h"
#include "runtime/light/light_sample_context.h"
#include "runtime/march/ray.h"
#include "runtime/path/medium_state.h"
#include "runtime/sampling/sampler.h"

namespace fathom::runtime {

// A camera path to be followed.
struct PathKey {
  int x, y;              // pixel
  std::uint32_t sample;  // of the pixel's, in the plan that draws them
  std::uint32_t unit;    // number of the unit that the path belongs to (runtime/unit_worker.h)
};

// The members that every vertex touches come first: a path's state is rarely in the first cache.
struct alignas(64) PathState {
  PathKey key;
  Sampler sampler;
  glm::vec3 throughput;
  float eta_scale;  // product of eta^2 over the refractions: their part of the throughput
  float weight;     // of the path in its pixel, by the filter
  int bounces;      // so far
  // The current ray and the medium that it travels through. At a vertex these become the next ray's, unless the path
  // ends. A ray of a path has no end.
  Ray ray;
  MediumState medium;
  int null_interactions;  // so far: holes and thin walls passed straight through, which are no bounces
  // While a shadow ray is under way: the light that it brings if it is unoccluded.
  bool has_shadow_ray;
  bool ends;  // after the shadow ray, if there is one
  glm::vec3 shadow_radiance;
  int shadow_bounces;  // of the path that the shadow ray would end
  // The last bounce, for MIS: its place, and the density per solid angle of the direction that was sampled there. The
  // density is 0 for a delta direction and for camera rays.
  float bsdf_pdf;
  LightSampleContext bounce_context;  // only in a scene with lights
  PathSample result;
};

// A ray from a vertex of a path towards a sampled light.
struct ShadowRay {
  MediumState medium;
  Ray ray;
  double length;              // to the light, a little more than ray.t_max
  int null_interactions = 0;  // so far
};

}  // namespace fathom::runtime
