#include "runtime/path/direct_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/base/color.h"
#include "runtime/path/emission.h"
#include "runtime/path/mis.h"
#include "runtime/path/scatter.h"

namespace fathom::runtime {
namespace {

// A shadow ray ends so many of the start's offsets before an area light met head-on, but no earlier than this share
// of its length.
constexpr double kShadowOffsets = 4, kMaxShortening = 0.1;
// A shadow ray with more null interactions counts as occluded. Few paths have so many.
constexpr int kMaxNullInteractions = 1024;

// Returns the length of the shadow ray to a sampled point on a light: up to just before the light's surface.
double shadow_length(const LightSample& light, const SurfacePoint& point) {
  const double cosine = std::max(static_cast<double>(light.light_cosine), 1e-3);
  const double before = kShadowOffsets * static_cast<double>(point.offset) / cosine;
  return light.distance - std::min(before, kMaxShortening * light.distance);
}

bool may_sample_light(const RenderContext& context, const VertexBatch& batch, std::size_t i) {
  const Settings& settings = context.settings;
  if (batch.has_bsdf[i] && batch.bsdf[i]->is_delta()) return false;
  if (settings.max_depth && batch.path[i]->bounces >= *settings.max_depth) return false;
  return settings.light_sampling != LightSampling::Bsdf || context.lights.has_delta_lights();
}

// Returns the radiance of the sampled light. The radiance of an area light may vary over its surface.
glm::vec3 light_radiance(const RenderContext& context, const VertexBatch& batch, std::size_t i,
                         RealScratch& scratch) {
  const LightSample& light = batch.light_sample[i];
  const Materials& materials = context.materials;
  if (light.material == kNoMaterial || !materials.is_textured(light.material)) return light.radiance;
  const glm::dvec3 position = batch.light_context[i].position + light.distance * glm::dvec3(light.wi);
  const glm::dvec3 place = materials.uses_object_space(light.material)
                               ? find_object_point(context.scene, context.field, position, scratch).place
                               : position;
  return materials.at(light.material, position, place, scratch.workspace).emitted_radiance();
}

// Sets the shadow ray of vertex i. Returns false if the light brings nothing.
bool set_shadow_ray(const RenderContext& context, VertexBatch& batch, std::size_t i, RealScratch& scratch) {
  PathState& path = *batch.path[i];
  const SurfaceInteraction& surface = batch.surface[i];
  const LightSample& light = batch.light_sample[i];
  const LightSampling sampling = context.settings.light_sampling;
  if (!(light.pdf > 0) || (!light.delta && sampling == LightSampling::Bsdf)) return false;
  const glm::vec3 radiance = light_radiance(context, batch, i, scratch);
  const BsdfValue value = evaluate_bsdf(batch, i, light.wi);
  const bool both = !light.delta && sampling == LightSampling::Mis;
  const float weight = both ? power_heuristic(light.pdf, value.pdf) : 1;
  const bool through = glm::dot(light.wi, surface.point->normal) < 0;
  const MediumState& medium = through ? *surface.medium_beyond : *surface.medium;
  const bool any_null = context.materials.any_null_transmission();
  // The surface of the medium would occlude the ray.
  if (!any_null && medium.field != 0 && std::isinf(light.distance)) return false;
  path.shadow_radiance = path.throughput * value.f * radiance * (weight / light.pdf);
  if (!any_null) path.shadow_radiance *= transmittance(medium, light.distance);
  if (!(max_component(path.shadow_radiance) > 0)) return false;
  path.shadow_bounces = path.bounces + 1;
  ShadowRay& shadow = batch.shadow_ray[i];
  shadow.medium = medium;
  set_spawned_ray(*surface.hit, *surface.point, glm::dvec3(light.wi), through, shadow.ray);
  shadow.ray.side = medium.side;
  shadow.ray.t_max = shadow_length(light, *surface.point);
  shadow.length = light.distance;
  shadow.null_interactions = 0;
  return true;
}

// True if the ray seeks the background and has come to no end of the medium that it is in. There is no background
// within a medium (add_background).
bool is_endless(std::size_t field, std::span<const ShadowRay> rays, std::uint32_t id) {
  return field != 0 && !rays.empty() && std::isinf(rays[id].length);
}

}  // namespace

void sample_lights(const RenderContext& context, VertexBatch& batch) {
  const Lights& lights = context.lights;
  for (std::size_t i = 0; i < batch.count; ++i) batch.light_sample[i].pdf = 0;
  batch.has_lights = !lights.empty();
  if (!batch.has_lights) return;
  for (std::size_t i = 0; i < batch.count; ++i) {
    const SurfaceInteraction& surface = batch.surface[i];
    LightSampleContext& at = batch.light_context[i];
    at.position = spawn_origin(*surface.hit, *surface.point, false);
    at.normal = surface.point->normal;
    at.both_sides = surface.material->transmits();
  }
  alignas(64) VertexRow<float> choice{}, u, v;
  if (lights.has_choice()) {
    batch.samplers.draw(batch.count, choice.data());
    batch.samplers.take_numbers(batch.count);
  }
  batch.samplers.draw_pairs(batch.count, u.data(), v.data());
  VertexRow<bool> active;
  for (std::size_t i = 0; i < batch.count; ++i) active[i] = may_sample_light(context, batch, i);
  static_assert(kVertexBatch <= LightQueries::kCapacity);
  const auto first = [&](const auto& row) { return std::span(row).first(batch.count); };
  lights.sample({first(batch.light_context), first(choice), first(u), first(v), first(active)}, batch.light_sample);
}

void sample_direct_light(const RenderContext& context, VertexBatch& batch, RealScratch& scratch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    batch.has_shadow_ray[i] = batch.path[i]->has_shadow_ray = set_shadow_ray(context, batch, i, scratch);
  }
}

void end_shadow_rays(const RenderContext& context, std::size_t field, std::span<const RayHit> ray_hits,
                     std::span<PathState> paths, std::span<const ShadowRay> rays) {
  for (const RayHit& ray_hit : ray_hits) {
    PathState& path = paths[ray_hit.id];
    path.has_shadow_ray = false;
    const bool missed = ray_hit.status == RayHit::Status::Miss || ray_hit.status == RayHit::Status::NearMiss;
    if (!missed || is_endless(field, rays, ray_hit.id)) continue;
    if (!rays.empty()) {
      const ShadowRay& shadow = rays[ray_hit.id];
      path.shadow_radiance *= transmittance(shadow.medium, std::max(0.0, shadow.length));
    }
    add_radiance(context.settings, path, path.shadow_radiance, path.shadow_bounces);
  }
}

void end_occluded_rays(std::span<const ShadowRay> rays, VertexBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    batch.active[i] = batch.surface[i].material->has_null_transmission() &&
                      rays[batch.id[i]].null_interactions < kMaxNullInteractions;
    batch.path[i]->has_shadow_ray = batch.active[i];
  }
}

void continue_shadow_rays(std::span<const ShadowRay> rays, VertexBatch& batch) {
  for_each_active(batch, [&](std::size_t i) {
    PathState& path = *batch.path[i];
    const SurfaceInteraction& surface = batch.surface[i];
    const ShadowRay& shadow = rays[batch.id[i]];
    const glm::vec3 passed = batch.has_bsdf[i] ? batch.bsdf[i]->null_transmission() : glm::vec3(0);
    path.shadow_radiance *= passed * transmittance(shadow.medium, batch.t[i]);
    path.has_shadow_ray = max_component(path.shadow_radiance) > 0;
    if (!path.has_shadow_ray) return;
    ShadowRay& next = batch.shadow_ray[i];
    set_spawned_ray(*surface.hit, *surface.point, shadow.ray.direction, true, next.ray);
    next.ray.side = surface.medium_beyond->side;
    // The ray starts behind the surface. Its end before the light stays in place.
    const double gone = glm::dot(next.ray.origin - shadow.ray.origin, shadow.ray.direction);
    next.ray.t_max = shadow.ray.t_max - gone;
    next.length = shadow.length - gone;
    next.null_interactions = shadow.null_interactions + 1;
    next.medium = *surface.medium_beyond;
    batch.has_shadow_ray[i] = true;
  });
}

}  // namespace fathom::runtime
