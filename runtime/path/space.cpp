#include "runtime/path/space.h"

#include <cmath>
#include <optional>

#include "runtime/path/surface.h"

namespace fathom::runtime {

Space space_at(glm::dvec3 place, const Media& media, const Materials& materials, RealScratch& scratch) {
  Space space;
  const std::optional<std::uint32_t> medium = media.at(place, scratch);
  if (!medium) return space;
  const MaterialPoint filling = filling_at(place, *medium, media, materials, scratch);
  space.field = *medium + 1;
  space.side = -1;
  if (!filling.fills()) return space;
  space.ior = filling.ior;
  space.absorption = filling.absorption;
  return space;
}

MaterialPoint filling_at(glm::dvec3 place, std::uint32_t medium, const Media& media, const Materials& materials,
                         RealScratch& scratch) {
  const std::uint32_t material = media.material(medium);
  if (!materials.placed(material)) return materials.at(material, place, place, scratch.workspace);
  const vm::SurfacePlace found = find_place(materials.scene(), media.field(medium), place, scratch);
  return materials.at(material, place, found.place, scratch.workspace);
}

bool is_even_around(glm::dvec3 place, double radius, const Field& scene, const Media& media, RealScratch& scratch) {
  if (radius == 0 || media.size() == 0) return true;
  const std::optional<std::uint32_t> medium = media.at(place, scratch);
  const Field& field = medium ? media.field(*medium) : scene;
  std::uint64_t instructions = 0;
  return std::abs(field.evaluate(place, scratch, instructions)) > radius * field.lipschitz;
}

}  // namespace fathom::runtime
