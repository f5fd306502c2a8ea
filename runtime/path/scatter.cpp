#include "runtime/path/scatter.h"

#include <algorithm>

#include "runtime/base/color.h"
#include "runtime/path/scatter_lanes.h"

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
  const float beyond = surface.material->has_interior() ? surface.medium_beyond->ior : surface.material->ior;
  return beyond / surface.medium->ior;
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

// Sets the next ray of vertex i.
void set_next_ray(const VertexBatch& batch, std::size_t i, PathState& path) {
  const SurfaceInteraction& surface = batch.surface[i];
  const bool through = batch.is_transmission[i];
  set_spawned_ray(*surface.hit, *surface.point, glm::dvec3(batch.wi[i]), through, path.ray);
  if (through) path.medium = *surface.medium_beyond;
  path.ray.side = path.medium.side;
}

void apply_bsdf_sample(const Settings& settings, const VertexBatch& batch, std::size_t i) {
  PathState& path = *batch.path[i];
  path.throughput *= batch.weight[i];
  path.eta_scale *= batch.eta_scale[i];
  path.ends = !(max_component(path.throughput) > 0);
  if (batch.is_null[i]) {  // direct light was sampled at the last bounce, through this surface, too
    if (++path.null_interactions > kFreeNullInteractions) {
      path.ends = path.ends || batch.roulette[i] >= kMaxSurvival;
      path.throughput /= kMaxSurvival;
    }
  } else {
    if (batch.has_lights) path.bounce_context = batch.light_context[i];
    path.bsdf_pdf = batch.pdf[i];
    ++path.bounces;
    path.ends = path.ends || !survives_roulette(settings, path, batch.roulette[i]);
  }
  if (!path.ends) set_next_ray(batch, i, path);
}

// Samples the BSDF of a vertex that has a Bsdf.
void sample_bsdf(VertexBatch& batch, std::size_t i) {
  const BsdfSample sample = batch.bsdf[i]->sample(batch.lobe[i], {batch.u[i], batch.v[i]});
  batch.wi.set(i, sample.wi);
  batch.weight.set(i, sample.weight);
  batch.pdf[i] = sample.pdf;
  batch.eta_scale[i] = sample.eta_scale;
  batch.is_transmission[i] = sample.is_transmission;
  batch.is_null[i] = sample.is_null;
}

// Draws the numbers that choose lobes, for the vertices whose BSDFs have several.
void draw_lobes(VertexBatch& batch) {
  const auto has_lobes = [&](std::size_t i) { return batch.has_bsdf[i] && batch.bsdf[i]->has_lobes(); };
  std::size_t first = 0;
  while (first < batch.count && !has_lobes(first)) ++first;
  if (first == batch.count) return;
  batch.samplers.draw(batch.count, batch.lobe.data());
  for (std::size_t i = first; i < batch.count; ++i) {
    if (has_lobes(i)) batch.samplers.take_number(i);
  }
}

// Draws the numbers for Russian roulette, for the vertices that use it.
void draw_roulette(const Settings& settings, VertexBatch& batch) {
  VertexRow<bool> uses;
  bool any = false;
  for (std::size_t i = 0; i < batch.count; ++i) {
    const PathState& path = *batch.path[i];
    uses[i] = uses_roulette(settings, path.bounces + 1) || path.null_interactions >= kFreeNullInteractions;
    any |= uses[i];
  }
  if (!any) return;
  batch.samplers.draw(batch.count, batch.roulette.data());
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (uses[i]) batch.samplers.take_number(i);
  }
}

bool is_diffuse(const MaterialPoint& material) {
  return material.type == MaterialType::Diffuse || material.type == MaterialType::Emissive;
}

}  // namespace

void make_bsdfs(VertexBatch& batch) {
  for_each_active(batch, [&](std::size_t i) {
    const SurfaceInteraction& surface = batch.surface[i];
    const glm::vec3 normal = surface.point->normal;
    batch.normal.set(i, normal);
    batch.albedo.set(i, surface.material->base_color);
    batch.has_bsdf[i] = !is_diffuse(*surface.material);
    if (batch.has_bsdf[i]) {
      batch.bsdf[i].emplace(*surface.material, normal, surface.hit->wo, relative_index(surface), surface.inside);
    }
  });
}

BsdfValue evaluate_bsdf(const VertexBatch& batch, std::size_t i, glm::vec3 wi) {
  if (batch.has_bsdf[i]) return batch.bsdf[i]->evaluate(wi);
  const float pdf = square_to_cosine_hemisphere_pdf({0, 0, glm::dot(wi, batch.normal[i])});
  return {batch.albedo[i] * pdf, pdf};
}

void sample_bsdfs(const Settings& settings, VertexBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    const PathState& path = *batch.path[i];
    batch.samplers.set(i, path.sampler);
    batch.samplers.start_bounce(i, path.bounces + path.null_interactions);
    batch.eta_scale[i] = 1;
    batch.is_transmission[i] = batch.is_null[i] = false;
  }
  batch.samplers.draw_pairs(batch.count, batch.u.data(), batch.v.data());
  batch.samplers.take_pairs(batch.count);
  draw_lobes(batch);
  draw_roulette(settings, batch);
  sample_diffuse(batch);
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (batch.has_bsdf[i]) sample_bsdf(batch, i);
  }
}

void apply_bsdf_samples(const Settings& settings, VertexBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) apply_bsdf_sample(settings, batch, i);
}

}  // namespace fathom::runtime
