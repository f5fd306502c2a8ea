#include "runtime/path/medium_interface.h"

#include <optional>

#include "runtime/field/pieces.h"

namespace fathom::runtime {
namespace {

// True if the ray comes out of the solid whose surface it hit, and not from the open or from another medium.
bool is_inside(const RenderContext& context, const SurfaceInteraction& surface) {
  if (surface.medium->field == 0) return surface.hit->side < 0;
  return context.media.material(surface.medium->field - 1) == surface.point->material;
}

// Returns the state at a place beyond the surface that no medium fills. It is the open, or a solid that blends and
// cuts of several materials leave without a medium: this solid then counts as a whole.
MediumState no_medium(const RenderContext& context, const SurfaceInteraction& surface, glm::dvec3 place,
                      RealScratch& scratch) {
  MediumState state;
  state.side = 1;
  if (surface.inside) return state;
  if (!find_solid(context.field, place, scratch)) return state;
  state.side = -1;
  if (surface.material->has_interior()) {
    state.ior = surface.material->ior;
    state.absorption = surface.material->absorption;
  }
  return state;
}

MediumState medium_beyond(const RenderContext& context, const SurfaceInteraction& surface, RealScratch& scratch) {
  const Media& media = context.media;
  MediumState state = *surface.medium;
  const glm::dvec3 place = spawn_origin(*surface.hit, *surface.point, true);
  std::optional<std::uint32_t> medium;
  if (media.size() > 1 || !surface.inside) medium = media.at(place, scratch);
  if (!medium) return no_medium(context, surface, place, scratch);
  state.field = *medium + 1;
  state.side = -1;
  const MaterialPoint interior = media.material(*medium) == surface.point->material
                                     ? *surface.material
                                     : interior_at(place, *medium, media, context.materials, scratch);
  if (interior.has_interior()) {
    state.ior = interior.ior;
    state.absorption = interior.absorption;
  }
  return state;
}

}  // namespace

void attenuate_paths(VertexBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    PathState& path = *batch.path[i];
    if (path.medium.absorption != glm::vec3(0)) path.throughput *= transmittance(path.medium, batch.t[i]);
  }
}

void find_media(const RenderContext& context, VertexBatch& batch, RealScratch& scratch) {
  for_each_active(batch, [&](std::size_t i) {
    SurfaceInteraction& surface = batch.surface[i];
    surface.inside = is_inside(context, surface);
    surface.medium_beyond = surface.medium;
    if (!surface.material->transmits()) return;
    batch.own_beyond[i] = medium_beyond(context, surface, scratch);
    surface.medium_beyond = &batch.own_beyond[i];
  });
}

}  // namespace fathom::runtime
