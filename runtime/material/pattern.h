// How the two values of a pattern are spread over space: a number in [0,1] for each point, 0 where it is `a`.
//
// Points are in the pattern's own coordinates. Cells are meant to end where they say and yet not in the middle of a
// surface: those of checker, stripes and bricks are moved by kOffset, so that a floor at height 0 lies in one layer.
// Tested by: tests/runtime/material/pattern_test.cpp
#pragma once

#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

// Far less than can be seen of a cell, and more than a hit is off the surface.
inline constexpr double kOffset = 0x1p-10;

// Beyond this, in cells, doubles tell few places of a cell apart: there patterns that repeat are 0.5.
inline constexpr double kLargestCell = 0x1p40;

// 0 or 1 in unit cubes by turns; 0 in the one from the origin to (1, 1, 1).
double checker(glm::dvec3 p);
// 0 in the first `width` of each unit along the axis, 1 in the rest; across a soft edge a cubic step.
double stripes(const compiler::Pattern::Stripes& stripes, glm::dvec3 p);
// 0 before `from`, 1 beyond `to`, linear between.
double gradient(const compiler::Pattern::Gradient& gradient, glm::dvec3 p);
// Octaves of gradient_noise(), each finer and weaker: 0.5 in the mean, clamped to [0,1].
double noise(const compiler::Pattern::Noise& noise, glm::dvec3 p);
// A wall in the xy plane, the same all along z: 1 in the mortar.
double bricks(const compiler::Pattern::Bricks& bricks, glm::dvec3 p);

// The pattern's value at a place in the coordinates of its space; NaN where the place is none.
double pattern_value(const compiler::Pattern& pattern, glm::dvec3 position);

// Noise that is 0 at whole coordinates and whose gradients there are those of a cube's edges, twice continuously
// differentiable; in [-1.04, 1.04]. Source: Perlin, "Improving Noise", SIGGRAPH 2002; a hash in place of his table.
double gradient_noise(glm::dvec3 p, std::uint64_t seed);

}  // namespace fathom::runtime
