#include "runtime/path/hits.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

bool is_hit(const RayHit& ray_hit) { return ray_hit.status == RayHit::Status::Hit; }

Hit make_hit(const RayHit& ray_hit, glm::dvec3 origin, glm::dvec3 direction) {
  return {origin + ray_hit.t * direction, glm::vec3(-direction), ray_hit.side, ray_hit.width};
}

MaterialPoint mix_of(const RenderContext& context, const vm::SurfaceShares& shares, glm::dvec3 position,
                     RealScratch& scratch) {
  const auto material = [&](const vm::SurfaceShare& share) {
    const std::uint32_t number = context.scene.surfaces[share.surface].material;
    return context.materials.at(number, position, share.place, scratch.workspace);
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

void find_material(const RenderContext& context, SurfaceInteraction& surface, RealScratch& scratch) {
  const std::uint32_t number = surface.point->material;
  const glm::dvec3 position = surface.hit->position;
  if (context.scene.surfaces[surface.point->surface].mixed) {
    const Field& field = context.field_at(surface.medium.field);
    const vm::SurfaceShares shares = find_blend_weights(context.scene, field, position, scratch);
    if (shares.count > 1) {
      surface.own_material = mix_of(context, shares, position, scratch);
      surface.material = &surface.own_material;
      return;
    }
  }
  surface.material = &context.materials.untextured(number);
  if (!context.materials.is_textured(number)) return;
  surface.own_material = context.materials.at(number, position, surface.point->place, scratch.workspace);
  surface.material = &surface.own_material;
}

void begin_vertex(const HitBatch& batch, std::size_t i, PathState& path, PathVertex& vertex) {
  vertex.id = batch.ray_hits[i].id;
  vertex.path = &path;
  vertex.t = batch.ray_hits[i].t;
  vertex.active = true;
  vertex.surface.hit = &batch.hits[i];
  vertex.surface.point = &batch.points[i];
  vertex.shadow_ray.reset();
}

}  // namespace

RayHitGroups group_ray_hits(std::span<RayHit> ray_hits, std::span<const PathState> paths,
                            bool has_null_transmission) {
  const auto tests_shadow = [&](const RayHit& ray_hit) { return paths[ray_hit.id].has_shadow_ray; };
  const auto ends_test = [&](const RayHit& ray_hit) {
    return tests_shadow(ray_hit) && (!has_null_transmission || !is_hit(ray_hit));
  };
  const auto tests_end = std::partition(ray_hits.begin(), ray_hits.end(), ends_test);
  const auto shadows_end = std::partition(tests_end, ray_hits.end(), tests_shadow);
  const auto hits_end = std::partition(shadows_end, ray_hits.end(), is_hit);
  return {
      {ray_hits.begin(), tests_end}, {tests_end, shadows_end}, {shadows_end, hits_end}, {hits_end, ray_hits.end()}};
}

void add_costs(std::span<const RayHit> ray_hits, std::span<PathState> paths) {
  for (const RayHit& ray_hit : ray_hits) {
    paths[ray_hit.id].result.evaluations += ray_hit.evaluations;
    paths[ray_hit.id].result.instructions += ray_hit.instructions;
  }
}

void set_path_hit_positions(std::span<const RayHit> ray_hits, std::span<const PathState> paths, HitBatch& batch) {
  batch.ray_hits = ray_hits;
  for (std::size_t i = 0; i < ray_hits.size(); ++i) {
    const PathState& path = paths[ray_hits[i].id];
    batch.hits[i] = make_hit(ray_hits[i], path.origin, path.direction);
  }
}

void set_shadow_hit_positions(std::span<const RayHit> ray_hits, std::span<const ShadowRay> rays, HitBatch& batch) {
  batch.ray_hits = ray_hits;
  for (std::size_t i = 0; i < ray_hits.size(); ++i) {
    const Ray& ray = rays[ray_hits[i].id].ray;
    batch.hits[i] = make_hit(ray_hits[i], ray.origin, ray.direction);
  }
}

void find_surface_points(const RenderContext& context, std::size_t field, HitBatch& batch, vm::Workspace& workspace,
                         RealScratch& scratch) {
  const std::span<const Hit> hits = std::span(batch.hits).first(batch.ray_hits.size());
  find_surfaces(context.scene, context.field_at(field), hits, batch.points, workspace);
  find_object_points(context.scene, context.field_at(field), hits, batch.points, scratch);
}

void begin_vertices(const HitBatch& batch, std::size_t first, std::span<PathState> paths,
                    std::span<PathVertex> vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const RayHit& ray_hit = batch.ray_hits[first + i];
    PathState& path = paths[ray_hit.id];
    begin_vertex(batch, first + i, path, vertices[i]);
    path.medium.side = ray_hit.side;
    vertices[i].surface.medium = path.medium;
  }
}

void begin_shadow_vertices(const HitBatch& batch, std::size_t first, std::span<PathState> paths,
                           std::span<const ShadowRay> rays, std::span<PathVertex> vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const RayHit& ray_hit = batch.ray_hits[first + i];
    begin_vertex(batch, first + i, paths[ray_hit.id], vertices[i]);
    vertices[i].surface.medium = rays[ray_hit.id].medium;
    vertices[i].surface.medium.side = ray_hit.side;
  }
}

void find_materials(const RenderContext& context, std::span<PathVertex> vertices, RealScratch& scratch) {
  for (PathVertex& vertex : vertices) find_material(context, vertex.surface, scratch);
}

std::uint64_t record_first_hits(const RenderContext& context, std::span<PathVertex> vertices) {
  std::uint64_t count = 0;
  for (PathVertex& vertex : vertices) {
    PathState& path = *vertex.path;
    if (path.bounces + path.null_interactions > 0) continue;
    ++count;
    const SurfaceInteraction& surface = vertex.surface;
    path.result.hit = true;
    path.result.albedo = albedo_of(*surface.material);
    path.result.normal = surface.point->normal;
    path.result.depth = vertex.t;
    path.result.position = surface.hit->position;
    path.result.surface = context.numbered ? surface.point->surface : kNoId;
    path.result.material = context.numbered ? surface.point->material : kNoId;
  }
  return count;
}

}  // namespace fathom::runtime
