#include "bench/emitted.h"

#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/emitted.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep

#include "bench/emitted_lanes.h"  // after the line above

HWY_BEFORE_NAMESPACE();
namespace fathom::bench::HWY_NAMESPACE {

#undef SCENE_A_DISTANCE_H
#undef SCENE_B_DISTANCE_H
#undef SCENE_C_DISTANCE_H
#undef SCENE_E_DISTANCE_H
#undef SCENE_D1000_DISTANCE_H
#include "scene_a.h"
#include "scene_b.h"
#include "scene_c.h"
#include "scene_d1000.h"
#include "scene_e.h"

// One function for each scene.
#define FATHOM_FIELD(name, scene)                                                                      \
  void name(vm::Points points, std::size_t count, float* distance) {                                   \
    using vm::HWY_NAMESPACE::Batch;                                                                    \
    using vm::HWY_NAMESPACE::kLanes;                                                                   \
    for (std::size_t i = 0; i + kLanes <= count; i += kLanes) {                                        \
      scene::distance(Batch::load(points.x + i), Batch::load(points.y + i), Batch::load(points.z + i)) \
          .store(distance + i);                                                                        \
    }                                                                                                  \
  }
FATHOM_FIELD(emitted_primitives, scene_a)
FATHOM_FIELD(emitted_csg, scene_b)
FATHOM_FIELD(emitted_mandelbulb, scene_c)
FATHOM_FIELD(emitted_gyroid, scene_e)
FATHOM_FIELD(emitted_thousand, scene_d1000)
#undef FATHOM_FIELD

}  // namespace fathom::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::bench {

#define FATHOM_FIELD(name, field)                                    \
  HWY_EXPORT(field);                                                 \
  void name(vm::Points points, std::size_t count, float* distance) { \
    HWY_DYNAMIC_DISPATCH(field)(points, count, distance);            \
  }
FATHOM_FIELD(primitives_emitted, emitted_primitives)
FATHOM_FIELD(csg_emitted, emitted_csg)
FATHOM_FIELD(mandelbulb_emitted, emitted_mandelbulb)
FATHOM_FIELD(gyroid_emitted, emitted_gyroid)
FATHOM_FIELD(thousand_emitted, emitted_thousand)
#undef FATHOM_FIELD

}  // namespace fathom::bench
#endif
