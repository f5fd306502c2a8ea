// Bounds on a field's slope cell by cell, for formulas whose slope has no bound, or a high one, in few places.
//
// A grid of several levels covers the formulas' boxes. A cell knows the maximum slope of the field over itself and
// its neighbours. A value then tells how far the field has no zero: the value over that slope, but no further than
// the neighbours reach. Among cells that hold no zero, a radius reaches as far as they do. The level that tells most
// counts. The radius is next to 0 in a cell without a bound, e.g. because a formula jumps there. The certified search
// then decides by interval arithmetic along the ray (runtime/march/certify.h).
//
//     const SlopeCells cells(program, box, rest_lipschitz);
//     cells.to_radii(points, count, values);      // a field with the Lipschitz constant 1
//
// Sources: Galin et al., "Segment Tracing Using Local Lipschitz Bounds", 2020 (local slopes); Barbier et al.,
// "Lipschitz Pruning", 2025 (programs pruned per cell).
// Tested by: tests/runtime/field/slope_cells_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "compiler/geometry/box.h"
#include "vm/interpret/points.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

// The grid as kernels read it. Level k has 2^k cells along each axis.
struct SlopeGrid {
  static constexpr int kLevels = 7;

  std::array<float, 3> lo{}, hi{};                  // of the grid
  std::array<float, 3> formula_lo{}, formula_hi{};  // of the formulas' box, within the grid
  std::array<float, 3> extent{};                    // of the grid, per axis
  int levels = 0;                                   // number of levels
  float inverse_rest = 0;                           // 1 / slope of the rest of the field, outside the grid
  // [level][z][y][x]: 1 / maximum slope over the cell and its neighbours; 0 if there is no bound, and infinite in
  // effect if none of these cells holds a zero.
  std::array<std::vector<float>, kLevels> inverse_slopes;
};

class SlopeCells {
 public:
  // `formulas`: finite box outside which the field has no zero except those of the rest of the field.
  // `rest_lipschitz`: Lipschitz constant of the rest, of which the field is the minimum with the formulas; 0 if there
  // is no rest.
  SlopeCells(const vm::VerifiedProgram& program, const compiler::Box& formulas, double rest_lipschitz);

  // Replaces each value by the radius of a ball around its point in which the field has no zero, with the value's
  // sign, scene units. A value that is not a number stays.
  void to_radii(vm::Points points, std::size_t count, float* values) const;
  // Returns the same for one point, from its value in double.
  double radius(double value, glm::dvec3 point) const;
  // Computes 1 / slope near points on the surface, by the level that tells most; 0 where there is no bound. Writes
  // whole registers.
  void inverse_slopes(vm::Points points, std::size_t count, float* out) const;

  // Size of the numbers that cancel in radii, scene units: the float error of a radius near a surface is
  // kDistanceError times (the size of the coordinates + cancellation()).
  float cancellation() const { return cancellation_; }
  // Length over which a search in double goes on from a place without a bound, before marchers try again: a few of
  // the finest cells, scene units.
  double stretch() const { return stretch_; }
  std::size_t bytes() const;

 private:
  SlopeGrid grid_;
  float cancellation_ = 0;
  double stretch_ = 0;
};

}  // namespace fathom::runtime
