#include "runtime/path/media.h"

#include <algorithm>

namespace fathom::runtime {

Media::Media(const compiler::CompiledScene& scene, double extent, std::optional<double> far) {
  for (const compiler::Medium& medium : scene.media) {
    media_.push_back({make_field(medium, extent, far), medium.material});
  }
}

void Media::add_regions(const compiler::CompiledScene& scene, RegionOptions options, RegionStore* store) {
  for (std::size_t i = 0; i < media_.size(); ++i) {
    Field& field = media_[i].field;
    runtime::add_regions(field, scene.media[i], options, store);
    if (field.regions) options.memory -= std::min(options.memory, field.regions->summary().bytes);
  }
}

void Media::add_native_code(double evaluations) {
  for (Medium& medium : media_) runtime::add_native_code(medium.field, evaluations);
}

std::optional<std::uint32_t> Media::at(glm::dvec3 place, RealScratch& scratch) const {
  std::uint64_t instructions = 0;
  for (std::uint32_t i = 0; i < media_.size(); ++i) {
    const Field& field = media_[i].field;
    if (field.bound.contains(place) && field.evaluate(place, scratch, instructions) < -field.rounding(place))
      return i;
  }
  return std::nullopt;
}

}  // namespace fathom::runtime
