#include "runtime/path/media.h"

#include "runtime/field/pieces.h"

namespace fathom::runtime {

Media::Media(const compiler::CompiledScene& scene, double extent, std::optional<double> far) {
  for (const compiler::Medium& medium : scene.media)
    media_.push_back({make_field(medium, extent, far), medium.material});
}

std::optional<std::uint32_t> Media::at(glm::dvec3 place, RealScratch& scratch) const {
  for (std::uint32_t i = 0; i < media_.size(); ++i) {
    const std::optional<PlaceInSolid> found = find_solid(media_[i].field, place, scratch);
    if (found && found->value < -media_[i].field.rounding(place)) return i;
  }
  return std::nullopt;
}

}  // namespace fathom::runtime
