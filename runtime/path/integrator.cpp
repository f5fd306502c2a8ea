#include "runtime/path/integrator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/color.h"
#include "runtime/path/camera_rays.h"
#include "runtime/path/direct_light.h"
#include "runtime/path/emission.h"
#include "runtime/path/medium_interface.h"
#include "runtime/path/scatter.h"

namespace fathom::runtime {
namespace {

bool is_finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Calls use(first, count) for the parts of a range, each with up to `size` elements.
template <class Use>
void for_each_part(std::size_t count, std::size_t size, const Use& use) {
  for (std::size_t first = 0; first < count; first += size) use(first, std::min(size, count - first));
}

}  // namespace

Integrator::Integrator(const RenderContext& context, PathSource& source, SampleSink& sink)
    : context_(context),
      source_(source),
      sink_(sink),
      queues_(context),
      paths_(queues_.capacity()),
      batch_(new VertexBatch()) {
  if (context.materials.any_null_transmission()) shadow_rays_.resize(paths_.size());
  for (std::size_t id = paths_.size(); id > 0; --id) free_ids_.push_back(static_cast<std::uint32_t>(id - 1));
}

void Integrator::run() {
  StageClock& clock = queues_.clock();
  if (context_.settings.profile) clock.start(Stage::Shading);
  bool more = true;
  while (true) {
    while (more && !free_ids_.empty()) more = start_paths();
    if (queues_.is_idle() || source_.is_abandoned()) break;
    for (std::size_t field = 0; field < queues_.fields(); ++field) {
      if (queues_.is_due(field) && queues_.advance(field)) process_ray_hits(field);
    }
  }
  clock.stop();
}

bool Integrator::start_paths() {
  queues_.clock().enter(Stage::Shading);
  std::array<PathKey, kCameraBatch> keys;
  std::array<std::uint32_t, kCameraBatch> ids;
  const std::size_t wanted = std::min(kCameraBatch, free_ids_.size());
  const std::size_t given = source_.next(std::span(keys).first(wanted));
  const std::span<const std::uint32_t> begun = std::span(ids).first(given);
  std::copy_n(free_ids_.rbegin(), given, ids.begin());
  free_ids_.resize(free_ids_.size() - given);
  begin_paths(context_, std::span(keys).first(given), begun, paths_, scratch_);
  for (const std::uint32_t id : begun) trace_path(id);
  stats_.primary_rays += given;
  return given == wanted;
}

void Integrator::process_ray_hits(std::size_t field) {
  StageClock& clock = queues_.clock();
  queues_.take_ray_hits(field, ray_hits_);
  if (context_.settings.layers.cost) add_costs(ray_hits_, paths_);
  clock.enter(Stage::Shading);
  const RayHitGroups groups = group_ray_hits(ray_hits_, paths_, !shadow_rays_.empty(), grouped_);
  end_shadow_rays(context_, field, groups.ended_shadow_rays, paths_, shadow_rays_);
  for (const RayHit& ray_hit : groups.ended_shadow_rays) continue_path(ray_hit.id);
  for_each_part(groups.shadow_hits.size(), kSurfaceBatch, [&](std::size_t first, std::size_t count) {
    process_shadow_hits(field, groups.shadow_hits.subspan(first, count));
  });
  for_each_part(groups.surface_hits.size(), kSurfaceBatch, [&](std::size_t first, std::size_t count) {
    shade_hits(field, groups.surface_hits.subspan(first, count));
  });
  add_background(context_, groups.escaped_rays, paths_);
  for (const RayHit& ray_hit : groups.escaped_rays) ended_ids_.push_back(ray_hit.id);
  clock.enter(Stage::Film);
  for (const std::uint32_t id : ended_ids_) retire_path(id);
  ended_ids_.clear();
}

void Integrator::shade_hits(std::size_t field, std::span<const RayHit> ray_hits) {
  HitBatch hits;
  queues_.clock().enter(Stage::Normals);
  set_path_hit_positions(ray_hits, paths_, hits);
  find_surface_points(context_, field, hits, queues_.workspace(field), scratch_);
  queues_.clock().enter(Stage::Shading);
  for_each_part(ray_hits.size(), kVertexBatch, [&](std::size_t first, std::size_t count) {
    begin_vertices(hits, first, count, paths_, *batch_);
    run_stages();
  });
}

void Integrator::run_stages() {
  VertexBatch& batch = *batch_;
  attenuate_paths(batch);
  find_materials(context_, batch, scratch_);
  find_media(context_, batch, scratch_);
  stats_.primary_hits += record_first_hits(context_, batch);
  add_emission(context_, batch);
  make_bsdfs(batch);
  sample_bsdfs(context_.settings, batch);
  sample_lights(context_, batch);
  sample_direct_light(context_, batch, scratch_);
  apply_bsdf_samples(context_.settings, batch);
  trace_next_rays();
}

void Integrator::process_shadow_hits(std::size_t field, std::span<const RayHit> ray_hits) {
  HitBatch hits;
  queues_.clock().enter(Stage::Normals);
  set_shadow_hit_positions(ray_hits, shadow_rays_, hits);
  find_surface_points(context_, field, hits, queues_.workspace(field), scratch_);
  queues_.clock().enter(Stage::Shading);
  for_each_part(ray_hits.size(), kVertexBatch, [&](std::size_t first, std::size_t count) {
    begin_shadow_vertices(hits, first, count, paths_, shadow_rays_, *batch_);
    run_shadow_stages();
  });
}

void Integrator::run_shadow_stages() {
  VertexBatch& batch = *batch_;
  find_materials(context_, batch, scratch_);
  end_occluded_rays(shadow_rays_, batch);
  find_media(context_, batch, scratch_);
  make_bsdfs(batch);
  continue_shadow_rays(shadow_rays_, batch);
  trace_next_rays();
}

void Integrator::trace_next_rays() {
  const VertexBatch& batch = *batch_;
  for (std::size_t i = 0; i < batch.count; ++i) {
    const std::uint32_t id = batch.id[i];
    if (!batch.has_shadow_ray[i]) {
      continue_path(id);
      continue;
    }
    const ShadowRay& shadow = batch.shadow_ray[i];
    ++stats_.shadow_rays;
    if (!shadow_rays_.empty()) shadow_rays_[id] = shadow;
    queues_.add(shadow.medium.field, id, shadow.ray);
  }
}

void Integrator::trace_path(std::uint32_t id) {
  const PathState& path = paths_[id];
  queues_.add(path.medium.field, id, path.ray);
}

void Integrator::continue_path(std::uint32_t id) {
  if (paths_[id].ends) return ended_ids_.push_back(id);
  ++stats_.bounce_rays;
  trace_path(id);
}

void Integrator::retire_path(std::uint32_t id) {
  PathState& path = paths_[id];
  if (!is_finite(path.result.radiance)) {
    ++stats_.dropped_samples;
    path.result.radiance = glm::vec3(0);
  }
  path.result.radiance *= path.weight;
  const float brightest = max_component(path.result.radiance);
  if (brightest > 0) ++stats_.lit_samples;
  if (brightest > 0 && brightest < static_cast<float>(kFaintLight)) ++stats_.faint_samples;
  if (!sink_.add(path.key, path.result)) ++stats_.saturated;
  free_ids_.push_back(id);
}

Stats Integrator::stats() const {
  Stats stats = stats_;
  queues_.count(stats.march);
  if (context_.settings.profile) stats.stages = queues_.stages();
  return stats;
}

}  // namespace fathom::runtime
