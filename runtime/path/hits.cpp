#include "runtime/path/hits.h"

namespace fathom::runtime {
namespace {

void set_hit(const RayHit& ray_hit, const Ray& ray, Hit& hit) {
  hit.position = ray.origin + ray_hit.t * ray.direction;
  hit.wo = glm::vec3(-ray.direction);
  hit.side = ray_hit.side;
  hit.width = ray_hit.width;
  hit.piece = ray_hit.piece;
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

// Finds the material of a vertex. `own`: where it is kept if it is not the same everywhere.
void find_material(const RenderContext& context, SurfaceInteraction& surface, MaterialPoint& own,
                   RealScratch& scratch) {
  const std::uint32_t number = surface.point->material;
  const glm::dvec3 position = surface.hit->position;
  if (context.scene.surfaces[surface.point->surface].mixed) {
    const Field& field = context.field_at(surface.medium->field);
    const vm::SurfaceShares shares = find_blend_weights(context.scene, field, *surface.hit, scratch);
    if (shares.count > 1) {
      own = mix_of(context, shares, position, scratch);
      surface.material = &own;
      return;
    }
  }
  surface.material = &context.materials.untextured(number);
  if (!context.materials.is_textured(number)) return;
  own = context.materials.at(number, position, surface.point->place, scratch.workspace);
  surface.material = &own;
}

// Begins vertex i at hit number `from`. `medium`: of the ray.
void begin_vertex(const HitBatch& hits, std::size_t from, PathState& path, MediumState& medium, VertexBatch& batch,
                  std::size_t i) {
  const RayHit& ray_hit = hits.ray_hits[from];
  batch.id[i] = ray_hit.id;
  batch.path[i] = &path;
  batch.t[i] = ray_hit.t;
  batch.active[i] = true;
  batch.has_shadow_ray[i] = false;
  medium.side = ray_hit.side;
  SurfaceInteraction& surface = batch.surface[i];
  surface.hit = &hits.hits[from];
  surface.point = &hits.points[from];
  surface.medium = &medium;
}

}  // namespace

// Counts before it moves: a branch on where a ray ended would be predicted wrong for every other ray.
RayHitGroups group_ray_hits(std::span<const RayHit> ray_hits, std::span<const PathState> paths,
                            bool has_null_transmission, std::vector<RayHit>& grouped) {
  enum Group : std::uint8_t { kEndedShadow, kShadowHit, kSurfaceHit, kEscaped, kGroups };
  const Group of_shadow[] = {kEndedShadow, has_null_transmission ? kShadowHit : kEndedShadow};
  const Group of_path[] = {kEscaped, kSurfaceHit};
  const auto group_of = [&](const RayHit& ray_hit) {
    const bool hit = ray_hit.status == RayHit::Status::Hit;
    return paths[ray_hit.id].has_shadow_ray ? of_shadow[hit] : of_path[hit];
  };
  std::size_t ends[kGroups] = {}, next[kGroups] = {};
  for (const RayHit& ray_hit : ray_hits) ++ends[group_of(ray_hit)];
  for (std::size_t group = 1; group < kGroups; ++group) {
    next[group] = ends[group - 1];
    ends[group] += ends[group - 1];
  }
  grouped.resize(ray_hits.size());
  for (const RayHit& ray_hit : ray_hits) grouped[next[group_of(ray_hit)]++] = ray_hit;
  const auto part = [&](Group group) {
    const std::size_t first = group == 0 ? 0 : ends[group - 1];
    return std::span<const RayHit>(grouped).subspan(first, ends[group] - first);
  };
  return {part(kEndedShadow), part(kShadowHit), part(kSurfaceHit), part(kEscaped)};
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
    set_hit(ray_hits[i], path.ray, batch.hits[i]);
  }
}

void set_shadow_hit_positions(std::span<const RayHit> ray_hits, std::span<const ShadowRay> rays, HitBatch& batch) {
  batch.ray_hits = ray_hits;
  for (std::size_t i = 0; i < ray_hits.size(); ++i) {
    set_hit(ray_hits[i], rays[ray_hits[i].id].ray, batch.hits[i]);
  }
}

void find_surface_points(const RenderContext& context, std::size_t field, HitBatch& batch, vm::Workspace& workspace,
                         RealScratch& scratch) {
  const std::span<const Hit> hits = std::span(batch.hits).first(batch.ray_hits.size());
  find_surfaces(context.scene, context.field_at(field), hits, batch.points, workspace);
  find_object_points(context.scene, context.field_at(field), hits, batch.points, scratch);
}

void begin_vertices(const HitBatch& hits, std::size_t first, std::size_t count, std::span<PathState> paths,
                    VertexBatch& batch) {
  batch.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    PathState& path = paths[hits.ray_hits[first + i].id];
    begin_vertex(hits, first + i, path, path.medium, batch, i);
  }
}

void begin_shadow_vertices(const HitBatch& hits, std::size_t first, std::size_t count, std::span<PathState> paths,
                           std::span<ShadowRay> rays, VertexBatch& batch) {
  batch.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t id = hits.ray_hits[first + i].id;
    begin_vertex(hits, first + i, paths[id], rays[id].medium, batch, i);
  }
}

void find_materials(const RenderContext& context, VertexBatch& batch, RealScratch& scratch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    find_material(context, batch.surface[i], batch.own_material[i], scratch);
  }
}

std::uint64_t record_first_hits(const RenderContext& context, VertexBatch& batch) {
  const FilmLayers& layers = context.settings.layers;
  const bool records = layers.first_hit || layers.position || layers.ids;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < batch.count; ++i) {
    PathState& path = *batch.path[i];
    if (path.bounces + path.null_interactions > 0) continue;
    ++count;
    path.result.hit = true;
    if (!records) continue;
    const SurfaceInteraction& surface = batch.surface[i];
    path.result.albedo = albedo_of(*surface.material);
    path.result.normal = surface.point->normal;
    path.result.depth = batch.t[i];
    path.result.position = surface.hit->position;
    path.result.surface = context.numbered ? surface.point->surface : kNoId;
    path.result.material = context.numbered ? surface.point->material : kNoId;
  }
  return count;
}

}  // namespace fathom::runtime
