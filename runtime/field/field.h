// What marching needs to know of a scene: its distance program and a few constants that hold for every ray.
// Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "compiler/scene/compiled_scene.h"
#include "runtime/field/far_levels.h"
#include "runtime/field/regions.h"
#include "vm/program/opcode.h"

namespace fathom::runtime {

class RegionStore;

struct Field {
  const vm::VerifiedProgram* distance;
  const vm::VerifiedProgram* surface;  // the same field with `tag`s
  compiler::Box bound;                 // the field is positive outside; a little larger than the scene's own
  double lipschitz;                    // |f(p) - f(q)| <= lipschitz * |p - q|
  double far;                          // rays end here, scene units; may be infinite when the bound is finite
  float band;                          // near the surface: distances at which a crossing is tried, scene units
  float inv_lipschitz;
  float magnitude;  // scene units (compiler/shapes/bounds.h)
  // Of iterated maps interval arithmetic knows nothing until a stretch is tiny. The longest one, scene units, over
  // which along() tells how steep the field is, on each of some lines near surfaces; infinite where all is proved.
  double longest_told;
  // How distances are rounded where nothing is near, of a scene so large that it could have regions: then what
  // follows evaluates to the same bits with them and without.
  FarLevels far_levels;
  std::shared_ptr<const Regions> regions;  // of a scene that gains by them
  // Whether float distances come with how far around the point the solid is convex (vm::evaluate_convex), which saves
  // evaluations where most of the scene is of convex shapes. Not of a large scene or an evaluator.
  bool convex;

  // Where it is set, float distances are taken from here: benches compare the machine with other evaluators of the
  // same scene. May read and write past `count` up to a whole register.
  void (*evaluator)(vm::Points points, std::size_t count, float* out);

  // How far a distance near 0 that double computes at p may be from the true one, scene units. A place is solid where
  // the field is below 0 by more than this: 0 over a volume is empty, whichever way its values are rounded.
  double rounding(glm::dvec3 p) const {
    const double place = std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return vm::kFloatError * 0x1p-29 * (place + static_cast<double>(magnitude));
  }

  bool knows_convex() const { return convex && evaluator == nullptr; }

  // Distances of many points in float, or of one or many in double; in a large scene rounded where nothing is near.
  // Regions leave in the scratch how many instructions each point took; in double they are added to `instructions`,
  // or put there for each.
  void evaluate(vm::Points points, std::size_t count, float* out, RegionScratch& scratch,
                vm::Workspace& workspace) const;
  double evaluate(glm::dvec3 point, RealScratch& scratch, std::uint64_t& instructions) const;
  void evaluate(vm::RealPoints points, std::size_t count, double* out, std::uint64_t* instructions,
                RealScratch& scratch) const;
  // What the field does along a stretch of a line, before it is rounded. The whole program tells, of a large scene at
  // a price.
  std::optional<vm::AlongLine> along(glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
                                     RealScratch& scratch, std::uint64_t& instructions) const;

 private:
  double rounded(double value, glm::dvec3 point) const;
};

// The scene's field. `far` empty: infinite in a bounded scene; else a thousand times the distance to the camera's
// target, and at least kDefaultFar.
Field make_field(const compiler::CompiledScene& scene, std::optional<double> far = std::nullopt);

// Any field. `extent`: the size of what is looked at, scene units.
Field make_field(const compiler::CompiledField& compiled, double extent, std::optional<double> far);

// The size of what is looked at, scene units: how far the camera's target is, but no more than half the bound's
// diagonal. A wide floor must not coarsen the things that stand on it.
double extent_of(const compiler::CompiledScene& scene);

inline constexpr double kDefaultFar = 1e4;  // scene units

// Builds the regions of `compiled`, if it gains by them, for its `field` and what evaluates surfaces with it. They
// are taken from `store` where it has them already.
void add_regions(Field& field, const compiler::CompiledField& compiled, const RegionOptions& options,
                 RegionStore* store = nullptr);

// d_f: how far a float32 distance d computed at p may be from the true one: 10 * 2^-24 * (max(1, |p|, |d|) +
// magnitude). The largest error measured over all primitives is 9 of these units; most stay below 6
// (tests/compiler/shapes/shapes_test.cpp).
inline constexpr float kDistanceError = static_cast<float>(vm::kFloatError);

inline float distance_error(const Field& field, float x, float y, float z, float distance) {
  return kDistanceError *
         (std::max({1.0f, std::abs(x), std::abs(y), std::abs(z), std::abs(distance)}) + field.magnitude);
}

}  // namespace fathom::runtime
