// Apart from bench/emitted.cpp, for it takes as long to compile as all of those together.
#include "bench/emitted.h"

#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/emitted_thousand.cpp"
// clang-format off
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "bench/emitted_lanes.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace fathom::bench::HWY_NAMESPACE {

#undef SCENE_D1000_DISTANCE_H
#include "scene_d1000.h"

void emitted_thousand(vm::Points points, std::size_t count, float* distance) {
  using vm::HWY_NAMESPACE::Batch;
  for (std::size_t i = 0; i + vm::HWY_NAMESPACE::kLanes <= count; i += vm::HWY_NAMESPACE::kLanes) {
    scene_d1000::distance(Batch::load(points.x + i), Batch::load(points.y + i), Batch::load(points.z + i))
        .store(distance + i);
  }
}

}  // namespace fathom::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::bench {

HWY_EXPORT(emitted_thousand);

void thousand_emitted(vm::Points points, std::size_t count, float* distance) {
  HWY_DYNAMIC_DISPATCH(emitted_thousand)(points, count, distance);
}

}  // namespace fathom::bench
#endif
