#include "bench/compiled_scenes/compiled_scenes.h"

#include <fmt/format.h>

#include <cstdlib>

#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/compiled_scenes/compiled_scenes.cpp"
// clang-format off
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "bench/compiled_scenes/compiled_scenes-inl.h"  // after the line above
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace fathom::bench::HWY_NAMESPACE {

std::span<const CompiledAhead> machine_scenes() { return scene_table(); }

}  // namespace fathom::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::bench {

HWY_EXPORT(machine_scenes);

std::span<const CompiledAhead> compiled_scenes() { return HWY_DYNAMIC_DISPATCH(machine_scenes)(); }

const CompiledAhead& find(std::span<const CompiledAhead> scenes, std::string_view name) {
  for (const CompiledAhead& scene : scenes) {
    if (name == scene.name) return scene;
  }
  fmt::print(stderr, "no scene {}\n", name);
  std::exit(1);
}

}  // namespace fathom::bench
#endif
