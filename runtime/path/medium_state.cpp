#include "runtime/path/medium_state.h"

#include <cmath>
#include <optional>

#include "runtime/field/pieces.h"
#include "runtime/path/surface.h"

namespace fathom::runtime {

MediumState medium_at(glm::dvec3 place, const Media& media, const Materials& materials, RealScratch& scratch) {
  MediumState state;
  const std::optional<std::uint32_t> medium = media.at(place, scratch);
  if (!medium) return state;
  const MaterialPoint interior = interior_at(place, *medium, media, materials, scratch);
  state.field = *medium + 1;
  state.side = -1;
  if (!interior.has_interior()) return state;
  state.ior = interior.ior;
  state.absorption = interior.absorption;
  return state;
}

MaterialPoint interior_at(glm::dvec3 place, std::uint32_t medium, const Media& media, const Materials& materials,
                          RealScratch& scratch) {
  const std::uint32_t material = media.material(medium);
  if (!materials.uses_object_space(material)) return materials.at(material, place, place, scratch.workspace);
  const Field& whole = media.field(medium);
  const std::optional<PlaceInSolid> solid = find_solid(whole, place, scratch);
  const Field& field = solid && solid->piece ? whole.pieces->fields[*solid->piece] : whole;
  const vm::SurfacePlace found = find_object_point(materials.scene(), field, place, scratch);
  return materials.at(material, place, found.place, scratch.workspace);
}

bool is_uniform_around(glm::dvec3 place, double radius, const Field& scene, const Media& media,
                       RealScratch& scratch) {
  if (radius == 0 || media.size() == 0) return true;
  const std::optional<std::uint32_t> medium = media.at(place, scratch);
  const Field& field = medium ? media.field(*medium) : scene;
  std::uint64_t instructions = 0;
  return std::abs(field.evaluate(place, scratch, instructions)) > radius * field.lipschitz;
}

}  // namespace fathom::runtime
