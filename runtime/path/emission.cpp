#include "runtime/path/emission.h"

#include <optional>

#include "runtime/base/color.h"
#include "runtime/path/mis.h"

namespace fathom::runtime {

void add_radiance(const Settings& settings, PathState& path, glm::vec3 radiance, int bounces) {
  const std::optional<double>& max = settings.clamp;
  if (max && bounces > 1) {
    const float brightest = max_component(radiance);
    if (brightest > static_cast<float>(*max)) radiance *= static_cast<float>(*max) / brightest;
  }
  path.result.radiance += radiance;
}

void add_emission(const RenderContext& context, std::span<PathVertex> vertices) {
  for (PathVertex& vertex : vertices) {
    const SurfaceInteraction& surface = vertex.surface;
    const glm::vec3 emitted_radiance = surface.material->emitted_radiance();
    if (emitted_radiance == glm::vec3(0)) continue;
    PathState& path = *vertex.path;
    float light_pdf = 0;
    if (path.bsdf_pdf > 0 && !context.lights.empty()) {
      light_pdf = context.lights.pdf_of_hit(path.bounce_context, surface.point->surface, surface.hit->position);
    }
    const float weight = bsdf_mis_weight(context.settings.light_sampling, path.bsdf_pdf, light_pdf);
    if (weight > 0) add_radiance(context.settings, path, path.throughput * emitted_radiance * weight, path.bounces);
  }
}

void add_background(const RenderContext& context, std::span<const RayHit> ray_hits, std::span<PathState> paths) {
  for (const RayHit& ray_hit : ray_hits) {
    PathState& path = paths[ray_hit.id];
    if (ray_hit.status == RayHit::Status::Invalid || path.medium.field != 0) continue;
    const glm::vec3 direction(path.direction);
    float light_pdf = 0;
    if (path.bsdf_pdf > 0 && !context.lights.empty()) {
      light_pdf = context.lights.pdf_of_background(path.bounce_context, direction);
    }
    const float weight = bsdf_mis_weight(context.settings.light_sampling, path.bsdf_pdf, light_pdf);
    if (!(weight > 0)) continue;
    const glm::vec3 background = context.lights.background(direction);
    add_radiance(context.settings, path, path.throughput * background * weight, path.bounces);
  }
}

}  // namespace fathom::runtime
