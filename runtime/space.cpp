#include "runtime/space.h"

#include <cmath>
#include <optional>

namespace fathom::runtime {

Space space_at(glm::dvec3 place, const Media& media, const Materials& materials, RealScratch& scratch) {
  Space space;
  const std::optional<std::uint32_t> medium = media.at(place, scratch);
  if (!medium) return space;
  const MaterialPoint filling = materials.at(media.material(*medium), place, scratch.workspace);
  space.field = *medium + 1;
  space.side = -1;
  if (!filling.fills()) return space;
  space.ior = filling.ior;
  space.absorption = filling.absorption;
  return space;
}

bool is_even_around(glm::dvec3 place, double radius, const Field& scene, const Media& media, RealScratch& scratch) {
  if (radius == 0 || media.size() == 0) return true;
  const std::optional<std::uint32_t> medium = media.at(place, scratch);
  const Field& field = medium ? media.field(*medium) : scene;
  std::uint64_t instructions = 0;
  return std::abs(field.evaluate(place, scratch, instructions)) > radius * field.lipschitz;
}

}  // namespace fathom::runtime
