// The insides of transparent bodies as fields of their own, and which of them a place lies in. A ray within one is
// followed against that field alone, so it meets the drink in the glass (compiler/analysis/media.h).
// Tested by: tests/runtime/path/media_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/field/field.h"

namespace fathom::runtime {

class Media {
 public:
  Media() = default;
  // `extent` and `far` as make_field() takes them.
  Media(const compiler::CompiledScene& scene, double extent, std::optional<double> far);

  std::size_t size() const { return media_.size(); }
  const Field& field(std::size_t medium) const { return media_[medium].field; }
  Field& field(std::size_t medium) { return media_[medium].field; }
  std::uint32_t material(std::size_t medium) const { return media_[medium].material; }

  // The medium that fills the place, in scene units of the programs; nothing in the open and within what is opaque.
  std::optional<std::uint32_t> at(glm::dvec3 place, RealScratch& scratch) const;

 private:
  struct Medium {
    Field field;
    std::uint32_t material;
  };
  std::vector<Medium> media_;
};

}  // namespace fathom::runtime
