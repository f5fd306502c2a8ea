// Smoke test: renders a few pixels of any scene and builds its regions. The result does not matter, only that nothing
// crashes.
#pragma once

#include "compiler/scene/compiled_scene.h"
#include "runtime/field/field.h"
#include "runtime/render.h"

namespace fathom::test {

// Renders nothing if the environment map is a file or the distance program is long.
inline void draw_small(const compiler::CompiledScene& scene) {
  constexpr std::uint32_t kMaxCost = 2000;  // multiply-adds per point
  if (scene.background.type == compiler::Background::Type::Image || scene.distance.cost() > kMaxCost) return;
  runtime::RenderOptions options;
  options.threads = 1, options.width = 4, options.height = 3, options.spp = 1, options.rr_depth = 1;
  runtime::render(scene, options);
  runtime::Field field = runtime::make_field(scene);
  runtime::RegionOptions regions;
  regions.always = true, regions.memory = 1 << 20;
  runtime::add_regions(field, scene, regions);
}

}  // namespace fathom::test
