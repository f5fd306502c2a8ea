// The parts of PiecewiseConstantSphere that run in lanes.
// Tested by: tests/runtime/sampling/piecewise_constant_sphere_test.cpp
#pragma once

#include <cstddef>

#include "runtime/sampling/sphere_tables.h"

namespace fathom::runtime {

// Directions as turns about y, 0 at +z and growing towards -x, and as distances along the axis from a pole, `pole` at
// y = 1 or -1, [ray].
struct PolarRows {
  alignas(64) float turns[DirectionRows::kCapacity] = {}, distance[DirectionRows::kCapacity] = {},
                    pole[DirectionRows::kCapacity] = {};
};
void set_directions(std::size_t count, const PolarRows& polar, DirectionRows& rows);

// Sets the places of directions on the sphere turned by `turn`, as PiecewiseConstantSphere::look_up(). Any direction,
// even NaN, has a place.
void find_cells(const SphereTables& tables, float turn, std::size_t count, const DirectionRows& rows,
                SphereCellRows& places);

// Sets the radiance at the places, interpolated bilinearly, and the density of their own cells.
void interpolate_cells(const SphereTables& tables, std::size_t count, const SphereCellRows& places,
                       DirectionRows& rows);

}  // namespace fathom::runtime
