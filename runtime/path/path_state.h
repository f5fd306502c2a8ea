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

struct PathState {
  PathKey key;
  Sampler sampler;
  // The current ray, scene units, and the medium that it travels through.
  glm::dvec3 origin;
  glm::dvec3 direction;
  MediumState medium;
  glm::vec3 throughput;
  float weight;           // of the path in its pixel, by the filter
  float eta_scale;        // product of eta^2 over the refractions: their part of the throughput
  int bounces;            // so far
  int null_interactions;  // so far: holes and thin walls passed straight through, which are no bounces
  // The last bounce, for MIS: its place, and the density per solid angle of the direction that was sampled there. The
  // density is 0 for a delta direction and for camera rays.
  LightSampleContext bounce_context;
  float bsdf_pdf;
  // While a shadow ray is under way: the light that it brings if it is unoccluded.
  bool has_shadow_ray;
  bool ends;  // after the shadow ray, if there is one
  glm::vec3 shadow_radiance;
  int shadow_bounces;  // of the path that the shadow ray would end
  // The next ray, unless the path ends.
  Ray next;
  MediumState next_medium;
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
