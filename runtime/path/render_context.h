// Data that every thread of a render reads and none writes.
#pragma once

#include <cstdint>
#include <optional>

#include "compiler/scene/compiled_scene.h"
#include "runtime/field/field.h"
#include "runtime/light/light.h"
#include "runtime/material/material.h"
#include "runtime/path/media.h"
#include "runtime/path/medium_state.h"
#include "runtime/path/options.h"
#include "runtime/sampling/camera.h"
#include "runtime/sampling/filter.h"
#include "runtime/sampling/sampler.h"

namespace fathom::runtime {

struct RenderContext {
  const compiler::CompiledScene& scene;
  Settings settings;
  Camera camera;
  Filter filter;
  Field field;
  Media media;
  Materials materials;
  Lights lights;
  std::optional<MediumState> camera_medium;  // the medium in which all camera rays begin, if it is the same for all
  bool numbered = true;  // surfaces and materials have the numbers that they have in the picture's own scene

  // Returns a field by its number, as MediumState::field has it.
  const Field& field_at(std::size_t number) const { return number == 0 ? field : media.field(number - 1); }
};

}  // namespace fathom::runtime
