#include "runtime/path/direct_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "runtime/base/color.h"
#include "runtime/path/emission.h"
#include "runtime/path/mis.h"

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

bool may_sample_light(const RenderContext& context, const PathVertex& vertex) {
  const Settings& settings = context.settings;
  if (vertex.bsdf->is_delta()) return false;
  if (settings.max_depth && vertex.path->bounces >= *settings.max_depth) return false;
  return settings.light_sampling != LightSampling::Bsdf || context.lights.has_delta_lights();
}

// Returns the radiance of the sampled light. The radiance of an area light may vary over its surface.
glm::vec3 light_radiance(const RenderContext& context, const PathVertex& vertex, RealScratch& scratch) {
  const LightSample& light = vertex.light_sample;
  const Materials& materials = context.materials;
  if (light.material == kNoMaterial || !materials.is_textured(light.material)) return light.radiance;
  const glm::dvec3 position = vertex.light_context.position + light.distance * glm::dvec3(light.wi);
  const glm::dvec3 place = materials.uses_object_space(light.material)
                               ? find_object_point(context.scene, context.field, position, scratch).place
                               : position;
  return materials.at(light.material, position, place, scratch.workspace).emitted_radiance();
}

// Returns nothing if the light brings nothing.
std::optional<ShadowRay> shadow_ray_of(const RenderContext& context, PathVertex& vertex, RealScratch& scratch) {
  PathState& path = *vertex.path;
  const SurfaceInteraction& surface = vertex.surface;
  const LightSample& light = vertex.light_sample;
  const LightSampling sampling = context.settings.light_sampling;
  if (!(light.pdf > 0) || (!light.delta && sampling == LightSampling::Bsdf)) return std::nullopt;
  const glm::vec3 radiance = light_radiance(context, vertex, scratch);
  const BsdfValue value = vertex.bsdf->evaluate(light.wi);
  const bool both = !light.delta && sampling == LightSampling::Mis;
  const float weight = both ? power_heuristic(light.pdf, value.pdf) : 1;
  const bool through = glm::dot(light.wi, surface.point->normal) < 0;
  const MediumState& medium = through ? surface.medium_beyond : surface.medium;
  const bool any_null = context.materials.any_null_transmission();
  // The surface of the medium would occlude the ray.
  if (!any_null && medium.field != 0 && std::isinf(light.distance)) return std::nullopt;
  path.shadow_radiance = path.throughput * value.f * radiance * (weight / light.pdf);
  if (!any_null) path.shadow_radiance *= transmittance(medium, light.distance);
  if (!(max_component(path.shadow_radiance) > 0)) return std::nullopt;
  path.shadow_bounces = path.bounces + 1;
  ShadowRay shadow{medium, spawn_ray(*surface.hit, *surface.point, glm::dvec3(light.wi), through), light.distance};
  shadow.ray.side = medium.side;
  shadow.ray.t_max = shadow_length(light, *surface.point);
  return shadow;
}

// True if the ray seeks the background and has come to no end of the medium that it is in. There is no background
// within a medium (add_background).
bool is_endless(std::size_t field, std::span<const ShadowRay> rays, std::uint32_t id) {
  return field != 0 && !rays.empty() && std::isinf(rays[id].length);
}

}  // namespace

void sample_lights(const RenderContext& context, std::span<PathVertex> vertices) {
  for (PathVertex& vertex : vertices) {
    vertex.light_sample.pdf = 0;
    if (context.lights.empty()) continue;
    const SurfaceInteraction& surface = vertex.surface;
    vertex.light_context = {spawn_origin(*surface.hit, *surface.point, false), surface.point->normal,
                            surface.material->transmits()};
    if (!may_sample_light(context, vertex)) continue;
    Sampler& sampler = vertex.path->sampler;
    const float choice = context.lights.has_choice() ? sampler.next() : 0;
    vertex.light_sample = context.lights.sample(vertex.light_context, choice, sampler.next2());
  }
}

void sample_direct_light(const RenderContext& context, std::span<PathVertex> vertices, RealScratch& scratch) {
  for (PathVertex& vertex : vertices) {
    vertex.shadow_ray = shadow_ray_of(context, vertex, scratch);
    vertex.path->has_shadow_ray = vertex.shadow_ray.has_value();
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

void end_occluded_rays(std::span<const ShadowRay> rays, std::span<PathVertex> vertices) {
  for (PathVertex& vertex : vertices) {
    vertex.active =
        vertex.surface.material->has_null_transmission() && rays[vertex.id].null_interactions < kMaxNullInteractions;
    vertex.path->has_shadow_ray = vertex.active;
  }
}

void continue_shadow_rays(std::span<const ShadowRay> rays, std::span<PathVertex> vertices) {
  for (PathVertex& vertex : vertices) {
    if (!vertex.active) continue;
    PathState& path = *vertex.path;
    const SurfaceInteraction& surface = vertex.surface;
    const ShadowRay& shadow = rays[vertex.id];
    path.shadow_radiance *= vertex.bsdf->null_transmission() * transmittance(shadow.medium, vertex.t);
    path.has_shadow_ray = max_component(path.shadow_radiance) > 0;
    if (!path.has_shadow_ray) continue;
    Ray ray = spawn_ray(*surface.hit, *surface.point, shadow.ray.direction, true);
    ray.side = surface.medium_beyond.side;
    // The ray starts behind the surface. Its end before the light stays in place.
    const double gone = glm::dot(ray.origin - shadow.ray.origin, shadow.ray.direction);
    ray.t_max = shadow.ray.t_max - gone;
    vertex.shadow_ray = ShadowRay{surface.medium_beyond, ray, shadow.length - gone, shadow.null_interactions + 1};
  }
}

}  // namespace fathom::runtime
