#include "runtime/path/emission.h"

#include <array>
#include <optional>
#include <utility>

#include "runtime/base/color.h"
#include "runtime/path/mis.h"

namespace fathom::runtime {
namespace {

// Returns the weight of the background's light that a path's ray has found, given the density of its direction as of
// Lights::look_up_background().
float background_weight(const RenderContext& context, const PathState& path, float density) {
  float light_pdf = 0;
  if (path.bsdf_pdf > 0 && !context.lights.empty()) {
    light_pdf = context.lights.pdf_of_background(path.bounce_context, glm::vec3(path.ray.direction), density);
  }
  return bsdf_mis_weight(context.settings.light_sampling, path.bsdf_pdf, light_pdf);
}

}  // namespace

void add_radiance(const Settings& settings, PathState& path, glm::vec3 radiance, int bounces) {
  const std::optional<double>& max = settings.clamp;
  float scale = 1;  // a factor, because to change `radiance` itself would cost a copy in memory
  if (max && bounces > 1) {
    const float brightest = max_component(radiance);
    if (brightest > static_cast<float>(*max)) scale = static_cast<float>(*max) / brightest;
  }
  path.result.radiance += radiance * scale;
}

void add_emission(const RenderContext& context, VertexBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    const SurfaceInteraction& surface = batch.surface[i];
    if (surface.material->emission == glm::vec3(0)) continue;
    const glm::vec3 emitted_radiance = surface.material->emitted_radiance();
    PathState& path = *batch.path[i];
    float light_pdf = 0;
    if (path.bsdf_pdf > 0 && !context.lights.empty()) {
      light_pdf = context.lights.pdf_of_hit(path.bounce_context, surface.point->surface, surface.hit->position);
    }
    const float weight = bsdf_mis_weight(context.settings.light_sampling, path.bsdf_pdf, light_pdf);
    if (weight > 0) add_radiance(context.settings, path, path.throughput * emitted_radiance * weight, path.bounces);
  }
}

void add_background(const RenderContext& context, std::span<const RayHit> ray_hits, std::span<PathState> paths) {
  DirectionRows rows;
  std::array<PathState*, DirectionRows::kCapacity> seeing;
  const auto add = [&](std::size_t count) {
    context.lights.look_up_background(count, rows);
    for (std::size_t i = 0; i < count; ++i) {
      PathState& path = *seeing[i];
      const float weight = background_weight(context, path, rows.density(i));
      if (!(weight > 0)) continue;
      add_radiance(context.settings, path, path.throughput * rows.radiance(i) * weight, path.bounces);
    }
  };
  std::size_t count = 0;
  for (const RayHit& ray_hit : ray_hits) {
    PathState& path = paths[ray_hit.id];
    if (ray_hit.status == RayHit::Status::Invalid || path.medium.field != 0) continue;
    seeing[count] = &path;
    rows.set_direction(count, glm::vec3(path.ray.direction));
    if (++count == DirectionRows::kCapacity) add(std::exchange(count, 0));
  }
  add(count);
}

}  // namespace fathom::runtime
