// The mix of a pattern's two values over space: a number in [0,1] for each point, 0 where the pattern is `a`.
//
// Points are in the pattern's own coordinates. A floor at height 0 lies on the border of two layers of cells.
// Checker, stripes and bricks are moved by kOffset, so that such a surface lies in one layer.
// Tested by: tests/runtime/material/pattern_test.cpp
#pragma once

#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

// Far less than the eye sees of a cell, and more than the distance of a hit from the surface.
inline constexpr double kOffset = 0x1p-10;

// Beyond this coordinate, in cells, doubles resolve few points of a cell, and patterns that repeat are 0.5.
inline constexpr double kLargestCell = 0x1p40;

// Returns 0 or 1 in alternate unit cubes, 0 in the cube from the origin to (1, 1, 1).
double checker(glm::dvec3 p);
// Returns 0 in the first `width` of each unit along the axis, 1 in the rest, and a cubic step across a soft edge.
double stripes(const compiler::Pattern::Stripes& stripes, glm::dvec3 p);
// Returns 0 before `from`, 1 beyond `to`, and a linear ramp between.
double gradient(const compiler::Pattern::Gradient& gradient, glm::dvec3 p);
// Returns a sum of octaves of gradient_noise(), each finer and weaker. The mean is 0.5, and the sum is clamped to
// [0,1].
double noise(const compiler::Pattern::Noise& noise, glm::dvec3 p);
// Returns 1 in the mortar of a wall in the xy plane, the same for all z, and 0 in the bricks.
double bricks(const compiler::Pattern::Bricks& bricks, glm::dvec3 p);

// Returns the pattern's value at a position in the coordinates of its space. NaN if the position is not finite.
double pattern_value(const compiler::Pattern& pattern, glm::dvec3 position);

// Returns noise that is 0 at whole coordinates, has the directions of a cube's edges as gradients there, and is twice
// continuously differentiable. In [-1.04, 1.04].
// Source: Perlin, "Improving Noise", SIGGRAPH 2002, with a hash in place of his table.
double gradient_noise(glm::dvec3 p, std::uint64_t seed);

}  // namespace fathom::runtime
