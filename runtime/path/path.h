// One light path on its way: what the integrator knows of it from one ray to the next.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "runtime/film/film.h"
#include "runtime/light/light.h"
#include "runtime/march/ray.h"
#include "runtime/path/space.h"
#include "runtime/sampling/sampler.h"

namespace fathom::runtime {

// One camera path to be followed.
struct PathKey {
  int x, y;              // pixel
  std::uint32_t sample;  // of the pixel's, in the plan that draws them
  std::uint32_t unit;    // whose film it goes to (runtime/unit_worker.h)
};

struct Path {
  PathKey key;
  Sampler sampler;
  glm::dvec3 origin;  // of the current ray, scene units
  glm::dvec3 direction;
  Space space;  // of the current ray
  glm::vec3 throughput;
  float weight;     // of the path in its pixel, by the filter
  float eta_scale;  // product of eta^2 over the crossings: what refraction alone has done to the throughput
  int bounces;      // made so far
  int crossings;    // of holes and thin walls, straight on: no bounces
  // Where the path was last scattered, and with which density per solid angle it left there; 0: by a delta, or from
  // the camera. What it crossed since, straight on, does not count.
  LightQuery from;
  float pdf;
  // While a shadow ray is under way: what it brings if nothing is in its way, and how the path goes on then.
  bool in_shadow_test;
  bool ends;
  glm::vec3 shadow_radiance;
  int shadow_bounces;  // of the path that it would end
  Ray next;
  Space next_space;
  PathSample result;
};

}  // namespace fathom::runtime
