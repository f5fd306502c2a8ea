// The scene as marching needs it: the distance program and a few constants that hold for every ray.
// Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "compiler/scene/compiled_scene.h"
#include "runtime/field/far_levels.h"
#include "runtime/field/regions.h"
#include "runtime/field/slope_cells.h"
#include "vm/native/native_program.h"
#include "vm/program/opcode.h"

namespace fathom::runtime {

class RegionStore;
struct Pieces;

struct Field {
  const vm::VerifiedProgram* distance;
  const vm::VerifiedProgram* surface;  // the same field with `tag` instructions
  compiler::Box bound;                 // the scene's bound with a margin, outside which the field is positive
  double lipschitz;                    // |f(p) - f(q)| <= lipschitz * |p - q|; may be infinite with `cells`
  double far;  // maximum length of rays, scene units; may be infinite when the bound is finite
  float band;  // distance below which a marcher tries to cross the surface, scene units
  float inv_lipschitz;
  float cancellation;         // size of the numbers that cancel in steps, scene units (compiler/shapes/bounds.h)
  double value_cancellation;  // the same for values, of which `cells` makes steps; otherwise equal
  // Maximum length of an interval, scene units, over which along() tells how steep the field is, tried on some lines
  // near surfaces. Interval arithmetic knows nothing of an iterated map until the interval is tiny. Infinite if the
  // compiler proved the field's Lipschitz constant, 0 for a large scene.
  double max_informative_length;
  // Rounding of distances where no surface is near, for scenes so large that they could have regions. The functions
  // below evaluate to the same bits with regions and without.
  FarLevels far_levels;
  std::shared_ptr<const Regions> regions;  // null unless the scene gains by regions
  // Bounds cell by cell, if the field has formulas without a bound of their slope or with a large one
  // (CompiledField::formula_box), or null.
  std::shared_ptr<const SlopeCells> cells;
  // True if float distances come with a convexity radius (vm::evaluate_convex), which saves evaluations in a scene
  // made mostly of convex shapes. False for large scenes.
  bool convex;

  // Machine code of the programs, or null: then the interpreter evaluates, with the same bits (add_native_code()).
  struct {
    std::shared_ptr<const vm::NativeProgram> distance, convex, surface;
  } native;

  std::shared_ptr<const Pieces> pieces;  // of the scene, which rays then meet one by one, or null (add_pieces())

  // Alternative to the machine for float distances, or null: benches compare the machine with other evaluators of the
  // same scene. The function may read and write past `count` up to a whole register.
  void (*evaluator)(vm::Points points, std::size_t count, float* out);

  // Returns the error of a distance near 0 that double computes at p, scene units. A point is solid if the field is
  // below 0 by more than this error: a field that is 0 over a volume is empty, however its values are rounded.
  double rounding(glm::dvec3 p) const {
    const double place = std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return vm::kFloatError * 0x1p-29 * (place + value_cancellation);
  }

  // True if the convexity radius is available, which `evaluator` does not compute.
  bool has_convexity() const { return convex && evaluator == nullptr; }

  // True if the field may jump, or be infinitely steep.
  bool may_jump() const { return std::isinf(lipschitz); }

  // Lipschitz constant of the values that marchers step by, to_steps().
  double step_lipschitz() const { return cells ? 1 : lipschitz; }
  // Replace values of evaluate() by those that marchers step by: the same, except in a field with `cells`.
  void to_steps(vm::Points points, std::size_t count, float* values) const {
    if (cells) cells->to_radii(points, count, values);
  }
  double to_step(double value, glm::dvec3 point) const { return cells ? cells->radius(value, point) : value; }

  // Evaluate distances: of many points in float, or of one or many in double. In a large scene the distances are
  // rounded where no surface is near. In float, regions leave the number of instructions per point in the scratch. In
  // double, the number is added to `instructions`, or written there per point.
  void evaluate(vm::Points points, std::size_t count, float* out, RegionScratch& scratch,
                vm::Workspace& workspace) const;
  // Evaluates distances and convexity radii; has_convexity() is true.
  void evaluate_convex(vm::Points points, std::size_t count, float* distance, float* convex_radius,
                       vm::Workspace& workspace) const;
  void evaluate_surface(vm::Points points, std::size_t count, vm::SurfaceValues out, vm::Workspace& workspace) const;
  double evaluate(glm::dvec3 point, RealScratch& scratch, std::uint64_t& instructions) const;
  void evaluate(vm::RealPoints points, std::size_t count, double* out, std::uint64_t* instructions,
                RealScratch& scratch) const;
  // Returns bounds on the unrounded field and on its derivative over an interval of a line. Evaluates the whole
  // program, which is expensive in a large scene.
  std::optional<vm::AlongLine> along(glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
                                     RealScratch& scratch, std::uint64_t& instructions) const;

 private:
  double rounded(double value, glm::dvec3 point) const;
};

// Makes the field of a scene. An empty `far` means infinite in a bounded scene, otherwise a thousand times the
// distance to the camera's target, but at least kDefaultFar.
Field make_field(const compiler::CompiledScene& scene, std::optional<double> far = std::nullopt);

// Makes any field. `extent` is the size of the subject, scene units.
Field make_field(const compiler::CompiledField& compiled, double extent, std::optional<double> far);

// Returns the size of the subject, scene units: the distance to the camera's target, but no more than half the
// bound's diagonal. A wide floor must not coarsen the things that stand on it.
double extent_of(const compiler::CompiledScene& scene);

// Compiles the programs that a field without regions evaluates to machine code, if `evaluations` repay it. Changes no
// bit of any result.
void add_native_code(Field& field, double evaluations);

inline constexpr double kDefaultFar = 1e4;  // scene units

// Builds the regions of `compiled`, if the scene gains by them, and gives them to its `field` and so to the
// evaluation of surfaces. `store`, if not null, provides regions that it already holds and keeps new ones.
void add_regions(Field& field, const compiler::CompiledField& compiled, const RegionOptions& options,
                 RegionStore* store = nullptr);

// d_f, the error bound of a float32 distance d computed at p: 10 * 2^-24 * (max(1, |p|, |d|) + cancellation). The
// largest error measured over all primitives has a factor of 9 in place of 10, and most errors stay below 6
// (tests/compiler/shapes/shapes_test.cpp).
inline constexpr float kDistanceError = static_cast<float>(vm::kFloatError);

inline float distance_error(const Field& field, float x, float y, float z, float distance) {
  return kDistanceError *
         (std::max({1.0f, std::abs(x), std::abs(y), std::abs(z), std::abs(distance)}) + field.cancellation);
}

}  // namespace fathom::runtime
