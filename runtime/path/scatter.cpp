#include "runtime/path/scatter.h"

#include <algorithm>

#include "runtime/base/color.h"

namespace fathom::runtime {
namespace {

// A path that loses nothing goes on for so many bounces beyond those without roulette, and from there with at most
// this probability, so that even a closed white room ends.
constexpr int kFreeBounces = 1024;
constexpr float kMaxSurvival = 0.95f;
// Null interactions without roulette.
constexpr int kFreeNullInteractions = 64;

// Returns the index of refraction beyond the surface relative to the ray's medium. A material that fills no body
// bends light at its surface all the same.
float relative_index(const SurfaceInteraction& surface) {
  const float beyond = surface.material->has_interior() ? surface.medium_beyond.ior : surface.material->ior;
  return beyond / surface.medium.ior;
}

bool uses_roulette(const Settings& settings, int bounces) {
  return !settings.max_depth && bounces >= settings.rr_depth;
}

// Past the bounces without roulette a path survives with probability q and then counts 1/q times: the mean stays.
// Refraction changes the throughput by eta^2, which does not end a path: the change is undone when the path leaves
// the medium.
bool survives_roulette(const Settings& settings, PathState& path, float roulette) {
  if (settings.max_depth) return path.bounces <= *settings.max_depth;
  if (!uses_roulette(settings, path.bounces)) return true;
  const float max = path.bounces - settings.rr_depth < kFreeBounces ? 1 : kMaxSurvival;
  const float q = std::min(max, max_component(path.throughput) * path.eta_scale);
  if (roulette >= q) return false;
  path.throughput /= q;
  return true;
}

void apply_bsdf_sample(const Settings& settings, PathVertex& vertex) {
  PathState& path = *vertex.path;
  const BsdfSample& sample = vertex.bsdf_sample;
  path.throughput *= sample.weight;
  path.eta_scale *= sample.eta_scale;
  path.ends = !(max_component(path.throughput) > 0);
  if (sample.is_null) {  // direct light was sampled at the last bounce, through this surface, too
    if (++path.null_interactions > kFreeNullInteractions) {
      path.ends = path.ends || vertex.roulette >= kMaxSurvival;
      path.throughput /= kMaxSurvival;
    }
  } else {
    path.bounce_context = vertex.light_context;
    path.bsdf_pdf = sample.pdf;
    ++path.bounces;
    path.ends = path.ends || !survives_roulette(settings, path, vertex.roulette);
  }
  if (path.ends) return;
  const SurfaceInteraction& surface = vertex.surface;
  path.next = spawn_ray(*surface.hit, *surface.point, glm::dvec3(sample.wi), sample.is_transmission);
  path.next_medium = sample.is_transmission ? surface.medium_beyond : surface.medium;
  path.next.side = path.next_medium.side;
}

}  // namespace

void make_bsdfs(std::span<PathVertex> vertices) {
  for (PathVertex& vertex : vertices) {
    if (!vertex.active) continue;
    const SurfaceInteraction& surface = vertex.surface;
    vertex.bsdf.emplace(*surface.material, surface.point->normal, surface.hit->wo, relative_index(surface),
                        surface.inside);
  }
}

void sample_bsdfs(const Settings& settings, std::span<PathVertex> vertices) {
  for (PathVertex& vertex : vertices) {
    const PathState& path = *vertex.path;
    Sampler& sampler = vertex.path->sampler;
    sampler.start_bounce(path.bounces + path.null_interactions);
    const glm::vec2 place = sampler.next2();
    vertex.bsdf_sample = vertex.bsdf->sample(vertex.bsdf->has_lobes() ? sampler.next() : 0, place);
    const bool uses = uses_roulette(settings, path.bounces + 1) || path.null_interactions >= kFreeNullInteractions;
    vertex.roulette = uses ? sampler.next() : 0;
  }
}

void apply_bsdf_samples(const Settings& settings, std::span<PathVertex> vertices) {
  for (PathVertex& vertex : vertices) apply_bsdf_sample(settings, vertex);
}

}  // namespace fathom::runtime
