// What happens to a path at a surface: its material and what lies beyond, emission, a light to look for, the next
// ray.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/base/elementary.h"
#include "runtime/path/integrator.h"

namespace fathom::runtime {
namespace {

// A path that loses nothing goes on for so many bounces beyond the settled ones, and from there with at most this
// probability, so that even a closed white room ends.
constexpr int kFreeBounces = 1024;
constexpr float kMostSurvival = 0.95f;
// A shadow ray ends so many of the start's offsets before a lamp met head-on, but takes no more than this share of
// its way off.
constexpr double kShadowOffsets = 4, kMostShortened = 0.1;

// Crossings of holes and thin walls that no roulette is played for, and after how many a shadow ray is given up: a
// path that makes so many has long ended by chance.
constexpr int kFreeCrossings = 64, kMostCrossings = 1024;
// Farther than this all is as far: none of 0 absorption times the distance is no number.
constexpr double kFarthest = 1e30;

float max_component(glm::vec3 v) { return std::max({v.x, v.y, v.z}); }

// Beer-Lambert law.
inline glm::vec3 transmittance(const Space& space, double distance) {
  if (space.absorption == glm::vec3(0)) [[likely]]
    return glm::vec3(1);
  return exp(-space.absorption * static_cast<float>(std::min(distance, kFarthest)));
}

// The power heuristic: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 9.2.
float power_heuristic(float this_pdf, float other_pdf) {
  const float ratio = other_pdf / this_pdf;
  return 1 / (1 + ratio * ratio);
}

// How long the way to a sampled place on a lamp is free to be looked along: up to just before the lamp itself.
double shadow_length(const LightSample& light, const SurfacePoint& point) {
  const double cosine = std::max(static_cast<double>(light.lamp_cosine), 1e-3);
  const double before = kShadowOffsets * static_cast<double>(point.offset) / cosine;
  return light.distance - std::min(before, kMostShortened * light.distance);
}

}  // namespace

// The share of light found by hitting it, where looking for lights would have found it with density `light_pdf`.
float Integrator::hit_share(const Path& path, float light_pdf) const {
  if (path.pdf == 0 || light_pdf == 0) return 1;
  switch (world_.settings.light_sampling) {
    case LightSampling::Both:
      return power_heuristic(path.pdf, light_pdf);
    case LightSampling::Hits:
      return 1;
    case LightSampling::Lights:
      return 0;
  }
  return 1;
}

// Light that a path of so many bounces brings.
void Integrator::add_light(Path& path, glm::vec3 radiance, int bounces) {
  const std::optional<double>& most = world_.settings.clamp;
  if (most && bounces > 1) {
    const float brightest = max_component(radiance);
    if (brightest > static_cast<float>(*most)) radiance *= static_cast<float>(*most) / brightest;
  }
  path.result.radiance += radiance;
}

// In steps of one kind each, so that the processor has several paths' in hand.
void Integrator::shade_vertices(std::span<const RayHit> ray_hits, std::span<const Hit> hits,
                                std::span<const SurfacePoint> points) {
  const std::span<Vertex> vertices = std::span(vertices_).first(ray_hits.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) meet(vertices[i], ray_hits[i], hits[i], points[i]);
  for (Vertex& vertex : vertices) sample_bsdf(vertex);
  for (Vertex& vertex : vertices) sample_light(vertex);
  for (Vertex& vertex : vertices) {
    const std::optional<ShadowRay> shadow = look_for_light(vertex);
    go_with(vertex);
    if (!shadow) {
      go_on(vertex.id);
      continue;
    }
    vertex.path->in_shadow_test = true;
    look_along(vertex.id, *shadow);
  }
}

void Integrator::meet(Vertex& vertex, const RayHit& ray_hit, const Hit& hit, const SurfacePoint& point) {
  Path& path = paths_[ray_hit.id];
  path.throughput *= transmittance(path.space, ray_hit.t);
  path.space.side = ray_hit.side;
  vertex.id = ray_hit.id;
  vertex.path = &path;
  vertex.hit = &hit;
  vertex.point = &point;
  vertex.space = path.space;
  find_material(vertex);
  vertex.inside = is_inside(vertex);
  vertex.beyond = beyond(vertex);
  if (path.bounces + path.crossings == 0) record_first_hit(vertex, ray_hit);
  add_emission(vertex);
  vertex.bsdf.emplace(*vertex.material, point.normal, hit.wo, relative_index(vertex), vertex.inside);
}

// The numbers that every hit needs are drawn first, so that they are the same dimensions in all samples.
void Integrator::sample_bsdf(Vertex& v) {
  Sampler& sampler = v.path->sampler;
  sampler.start_bounce(v.path->bounces + v.path->crossings);
  const glm::vec2 place = sampler.next2();
  v.next = v.bsdf->sample(v.bsdf->has_lobes() ? sampler.next() : 0, place);
  const bool plays = plays_roulette(v.path->bounces + 1) || v.path->crossings >= kFreeCrossings;
  v.roulette = plays ? sampler.next() : 0;
}

// Where a blend mixes materials each counts by its share.
void Integrator::find_material(Vertex& v) {
  const std::uint32_t number = v.point->material;
  const glm::dvec3 place = v.hit->position;
  if (world_.scene.surfaces[v.point->surface].mixed) {
    const vm::SurfaceShares shares = find_shares(world_.scene, field(v.space.field), place, scratch_);
    if (shares.count > 1) {
      v.made = mix_of(shares, place);
      v.material = &v.made;
      return;
    }
  }
  v.material = &world_.materials.typical(number);
  if (!world_.materials.varies(number)) return;
  v.made = world_.materials.at(number, place, v.point->place, scratch_.workspace);
  v.material = &v.made;
}

MaterialPoint Integrator::mix_of(const vm::SurfaceShares& shares, glm::dvec3 place) {
  const Materials& materials = world_.materials;
  const auto material = [&](const vm::SurfaceShare& share) {
    return materials.at(world_.scene.surfaces[share.surface].material, place, share.place, scratch_.workspace);
  };
  MaterialPoint mixed = material(shares.all[0]);
  double weight = shares.all[0].weight;
  for (int i = 1; i < shares.count; ++i) {
    const vm::SurfaceShare& share = shares.all[static_cast<std::size_t>(i)];
    weight += share.weight;
    mixed = mix(mixed, material(share), static_cast<float>(share.weight / weight));
  }
  return mixed;
}

// Whether the path comes out of the solid whose surface it met, or else out of the open or of another medium.
bool Integrator::is_inside(const Vertex& v) const {
  if (v.space.field == 0) return v.hit->side < 0;
  return world_.media.material(v.space.field - 1) == v.point->material;
}

// Of what is beyond the surface, relative to where the path is. What does not fill a body bends light at its surface
// all the same.
float Integrator::relative_index(const Vertex& v) const {
  return (v.material->fills() ? v.beyond.ior : v.material->ior) / v.space.ior;
}

// What a path gets into that goes through the surface.
Space Integrator::beyond(const Vertex& v) {
  if (!v.material->transmits()) return v.space;
  const Media& media = world_.media;
  Space space = v.space;
  const glm::dvec3 place = spawn(*v.hit, *v.point, true);
  std::optional<std::uint32_t> medium;
  if (media.size() > 1 || !v.inside) medium = media.at(place, scratch_);
  if (!medium) return no_medium(v, place);
  space.field = *medium + 1;
  space.side = -1;
  const std::uint32_t material = media.material(*medium);
  const MaterialPoint filling =
      material == v.point->material ? *v.material : filling_at(place, *medium, media, world_.materials, scratch_);
  if (filling.fills()) {
    space.ior = filling.ior;
    space.absorption = filling.absorption;
  }
  return space;
}

// The open; or, where blends and cuts of several materials leave a solid without a medium, that solid as a whole.
Space Integrator::no_medium(const Vertex& v, glm::dvec3 place) {
  Space space;
  space.side = 1;
  if (v.inside) return space;
  std::uint64_t instructions = 0;
  if (world_.field.evaluate(place, scratch_, instructions) >= 0) return space;
  space.side = -1;
  if (v.material->fills()) {
    space.ior = v.material->ior;
    space.absorption = v.material->absorption;
  }
  return space;
}

void Integrator::record_first_hit(const Vertex& v, const RayHit& ray_hit) {
  ++stats_.primary_hits;
  PathSample& result = v.path->result;
  result.hit = true;
  result.albedo = albedo_of(*v.material);
  result.normal = v.point->normal;
  result.depth = ray_hit.t;
  result.position = v.hit->position;
  result.surface = world_.numbered ? v.point->surface : kNoId;
  result.material = world_.numbered ? v.point->material : kNoId;
}

void Integrator::add_emission(const Vertex& v) {
  const glm::vec3 emitted = v.material->emitted();
  if (emitted == glm::vec3(0)) return;
  const Path& path = *v.path;
  float light_pdf = 0;
  if (path.pdf > 0 && !world_.lights.empty()) {
    light_pdf = world_.lights.pdf_of_hit(path.from, v.point->surface, v.hit->position);
  }
  const float share = hit_share(path, light_pdf);
  if (share > 0) add_light(*v.path, path.throughput * emitted * share, path.bounces);
}

// A light is chosen and a place on it.
void Integrator::sample_light(Vertex& v) {
  v.light.pdf = 0;
  if (world_.lights.empty()) return;
  Path& path = *v.path;
  const Settings& settings = world_.settings;
  v.query = {spawn(*v.hit, *v.point, false), v.point->normal, v.material->transmits()};
  if (v.bsdf->is_delta()) return;
  if (settings.cut_after && path.bounces >= *settings.cut_after) return;
  if (settings.light_sampling == LightSampling::Hits && !world_.lights.has_deltas()) return;
  const float choice = world_.lights.has_choice() ? path.sampler.next() : 0;
  v.light = world_.lights.sample(v.query, choice, path.sampler.next2());
}

// What the light would bring is kept until the shadow ray has told.
std::optional<Integrator::ShadowRay> Integrator::look_for_light(Vertex& v) {
  Path& path = *v.path;
  LightSample& light = v.light;
  const LightSampling way = world_.settings.light_sampling;
  if (!(light.pdf > 0) || (!light.delta && way == LightSampling::Hits)) return std::nullopt;
  if (light.material != kNoMaterial && world_.materials.varies(light.material)) {
    const glm::dvec3 lamp = v.query.position + light.distance * glm::dvec3(light.wi);
    const glm::dvec3 place =
        world_.materials.placed(light.material) ? find_place(world_.scene, world_.field, lamp, scratch_).place : lamp;
    light.radiance = world_.materials.at(light.material, lamp, place, scratch_.workspace).emitted();
  }
  const BsdfValue value = v.bsdf->evaluate(light.wi);
  const bool both = !light.delta && way == LightSampling::Both;
  const float share = both ? power_heuristic(light.pdf, value.pdf) : 1;
  const bool through = glm::dot(light.wi, v.point->normal) < 0;
  const Space& space = through ? v.beyond : v.space;
  if (shadows_.empty() && space.field != 0 && std::isinf(light.distance)) return std::nullopt;  // no way out
  path.shadow_radiance = path.throughput * value.f * light.radiance * (share / light.pdf);
  if (shadows_.empty()) path.shadow_radiance *= transmittance(space, light.distance);
  if (!(max_component(path.shadow_radiance) > 0)) return std::nullopt;
  path.shadow_bounces = path.bounces + 1;
  ShadowRay shadow{space, leave(*v.hit, *v.point, glm::dvec3(light.wi), through), light.distance};
  shadow.ray.side = space.side;
  shadow.ray.t_max = shadow_length(light, *v.point);
  return shadow;
}

void Integrator::go_with(const Vertex& v) {
  Path& path = *v.path;
  const BsdfSample& next = v.next;
  path.throughput *= next.weight;
  path.eta_scale *= next.eta_scale;
  path.ends = !(max_component(path.throughput) > 0);
  if (next.straight) {  // light was looked for at the place before, through here, too
    if (++path.crossings > kFreeCrossings) {
      path.ends = path.ends || v.roulette >= kMostSurvival;
      path.throughput /= kMostSurvival;
    }
  } else {
    path.from = v.query;
    path.pdf = next.pdf;
    ++path.bounces;
    path.ends = path.ends || !survives(path, v.roulette);
  }
  if (path.ends) return;
  path.next = leave(*v.hit, *v.point, glm::dvec3(next.wi), next.through);
  path.next_space = next.through ? v.beyond : path.space;
  path.next.side = path.next_space.side;
}

// After so many bounces.
bool Integrator::plays_roulette(int bounces) const {
  return !world_.settings.cut_after && bounces >= world_.settings.bounces;
}

// Past the settled number of bounces a path survives with probability q and then counts 1/q times: the mean stays.
// What refraction does to radiance is no reason to end a path, for it is undone where the path comes out again.
bool Integrator::survives(Path& path, float roulette) const {
  if (world_.settings.cut_after) return path.bounces <= *world_.settings.cut_after;
  if (!plays_roulette(path.bounces)) return true;
  const float most = path.bounces - world_.settings.bounces < kFreeBounces ? 1 : kMostSurvival;
  const float q = std::min(most, max_component(path.throughput) * path.eta_scale);
  if (roulette >= q) return false;
  path.throughput /= q;
  return true;
}

void Integrator::look_along(std::uint32_t id, const ShadowRay& shadow) {
  ++stats_.shadow_rays;
  if (!shadows_.empty()) shadows_[id] = shadow;
  marcher(shadow.space.field).add(id, shadow.ray);
}

// Where a shadow ray met a surface; of the vertex only what concerns the surface is made.
void Integrator::pass_shadow(const RayHit& ray_hit, const Hit& hit, const SurfacePoint& point) {
  const ShadowRay& shadow = shadows_[ray_hit.id];
  Path& path = paths_[ray_hit.id];
  Vertex& vertex = passed_;
  vertex.hit = &hit;
  vertex.point = &point;
  vertex.space = shadow.space;
  vertex.space.side = ray_hit.side;
  find_material(vertex);
  const bool passes = vertex.material->passes_straight() && shadow.crossings < kMostCrossings;
  if (!passes) return end_shadow_test(ray_hit.id, false);
  vertex.inside = is_inside(vertex);
  vertex.beyond = beyond(vertex);
  const Bsdf bsdf(*vertex.material, point.normal, hit.wo, relative_index(vertex), vertex.inside);
  path.shadow_radiance *= bsdf.straight_through() * transmittance(shadow.space, ray_hit.t);
  if (!(max_component(path.shadow_radiance) > 0)) return end_shadow_test(ray_hit.id, false);
  Ray ray = leave(hit, point, shadow.ray.direction, true);
  ray.side = vertex.beyond.side;
  // It starts behind the surface, and must end before the lamp all the same.
  const double gone = glm::dot(ray.origin - shadow.ray.origin, shadow.ray.direction);
  ray.t_max = shadow.ray.t_max - gone;
  look_along(ray_hit.id, {vertex.beyond, ray, shadow.length - gone, shadow.crossings + 1});
}

void Integrator::end_shadow_test(std::uint32_t id, bool free) {
  Path& path = paths_[id];
  path.in_shadow_test = false;
  if (free && !shadows_.empty()) {
    path.shadow_radiance *= transmittance(shadows_[id].space, std::max(0.0, shadows_[id].length));
  }
  if (free) add_light(path, path.shadow_radiance, path.shadow_bounces);
  go_on(id);
}

void Integrator::go_on(std::uint32_t id) {
  Path& path = paths_[id];
  if (path.ends) return ended_.push_back(id);
  path.space = path.next_space;
  ++stats_.bounce_rays;
  follow(id, path.next);
}

}  // namespace fathom::runtime
