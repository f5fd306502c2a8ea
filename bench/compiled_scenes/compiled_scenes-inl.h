// The table of compiled_scenes.h, for one instruction set. `fathom emit cpp` makes the headers scene_*.h.
#if defined(FATHOM_BENCH_COMPILED_SCENES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_BENCH_COMPILED_SCENES_INL
#undef FATHOM_BENCH_COMPILED_SCENES_INL
#else
#define FATHOM_BENCH_COMPILED_SCENES_INL
#endif

#include "bench/compiled_scenes/compiled_scenes.h"
#include "bench/emitted_lanes.h"
#include "bench/many_objects.h"
#include "bench/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::bench::HWY_NAMESPACE {
namespace {

#undef SCENE_A_DISTANCE_H
#undef SCENE_B_DISTANCE_H
#undef SCENE_C_DISTANCE_H
#undef SCENE_D1000_DISTANCE_H
#undef SCENE_E_DISTANCE_H
#undef SCENE_F_DISTANCE_H
#include "scene_a.h"
#include "scene_b.h"
#include "scene_c.h"
#include "scene_d1000.h"
#include "scene_e.h"
#include "scene_f.h"

// kLevel: the constant that the scene file subtracts from the distance, so that its surface is where classic sphere
// tracing has its hits.
#define FATHOM_SCENE(Name, scene, level, inlining)                                                 \
  struct Name {                                                                                    \
    static constexpr double kLevel = level;                                                        \
    static inlining Batch distance(Batch x, Batch y, Batch z) { return scene::distance(x, y, z); } \
  };
FATHOM_SCENE(Primitives, scene_a, 0, HWY_INLINE)
FATHOM_SCENE(Csg, scene_b, 0, HWY_INLINE)
FATHOM_SCENE(Bulb, scene_c, 5e-4, HWY_INLINE)
FATHOM_SCENE(Gyroid, scene_e, 1e-3, HWY_INLINE)
FATHOM_SCENE(Formula, scene_f, 0, HWY_INLINE)
FATHOM_SCENE(Thousand, scene_d1000, 2e-4, HWY_NOINLINE)  // a thousand lines, used in a dozen places
#undef FATHOM_SCENE

// A loop over the objects: nobody would write ten thousand lines, one per object.
template <int count>
struct Scattered {
  static constexpr double kLevel = 0;
  static HWY_NOINLINE Batch distance(Batch x, Batch y, Batch z) {
    static const ManyObjects objects = make_many_objects(count);
    Batch nearest = c(std::numeric_limits<float>::infinity());
    for (const ManyObjects::Sphere& s : objects.spheres) {
      nearest = min(nearest, length(x - broadcast(s.x), y - broadcast(s.y), z - broadcast(s.z)) - broadcast(s.r));
    }
    for (const ManyObjects::Box& b : objects.boxes) {
      const Batch qx = abs(x - broadcast(b.x)) - broadcast(b.hx), qy = abs(y - broadcast(b.y)) - broadcast(b.hy);
      const Batch qz = abs(z - broadcast(b.z)) - broadcast(b.hz);
      nearest = min(nearest, length(max(qx, c(0)), max(qy, c(0)), max(qz, c(0))) + min(max(qx, max(qy, qz)), c(0)));
    }
    return nearest;
  }

 private:
  static HWY_INLINE Batch broadcast(float value) { return Batch::broadcast(value); }
};

template <class Scene>
void distances(Points points, std::size_t count, float* distance) {
  for (std::size_t i = 0; i < count; i += kLanes) {
    Scene::distance(Batch::load(points.x + i), Batch::load(points.y + i), Batch::load(points.z + i))
        .store(distance + i);
  }
}

template <class Scene>
CompiledAhead entry(const char* name, const char* path, const View& view) {
  return {name, path, view, distances<Scene>, render_shadow<Scene>, render_paths<Scene>};
}

std::span<const CompiledAhead> scene_table() {
  const View many{{2, 1.5, 2.4}, {0.5, 0.5, 0.5}, 35, 2e-4, 8};
  static const CompiledAhead scenes[] = {
      entry<Primitives>("A", "scenes/bench/a-primitives.json", {{0, 5.5, 9.5}, {0, 0.8, 0}, 40, 1e-3, 40}),
      entry<Csg>("B", "scenes/bench/b-csg.json", {{4.2, 3.2, 5}, {0, 1, 0}, 40, 1e-3, 40}),
      entry<Bulb>("C", "scenes/bench/c-mandelbulb.json", {{1.6, 1.1, 1.9}, {0, 0, 0}, 45, 5e-4, 8}),
      entry<Gyroid>("E", "scenes/bench/e-gyroid.json", {{1.7, 1.3, 2}, {0, 0, 0}, 40, 1e-3, 8}),
      entry<Formula>("F", "scenes/bench/f-formula.json", {{2.6, 1.8, 3}, {0, 0, 0}, 40, 1e-3, 8}),
      entry<Thousand>("D1000", "scenes/bench/d1000.json", many),
      entry<Scattered<10000>>("D10000", "scenes/bench/d10000.json", many),
      entry<Scattered<100000>>("D100000", FATHOM_SCENE_D100000, many),
  };
  return scenes;
}

}  // namespace
}  // namespace fathom::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
