// Outlines for the judge: the boundary as explicit segments and arcs, and an inside test by the shape's definition.
// The distance is the distance to the nearest piece. The judge is slow and obvious and, unlike the machine, does not
// exploit symmetry.
// Tested by: tests/compiler/shapes/shapes_test.cpp (against tests/support/judge/brute_force_outlines.h)
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"

namespace fathom::test {

// Straight segment from `a` to `b`, or the part of an ellipse about `centre`, axes along x and y, between two angles
// from +x towards +y: centre + (radii.x cos t, radii.y sin t).
struct Piece {
  bool straight;
  glm::dvec2 a, b;
  glm::dvec2 centre, radii;
  double from, to;  // radians, from < to <= from + 2 pi
};

// Returns the pieces of the boundary in no particular order. Pieces meet at their ends only.
std::vector<Piece> outline_boundary(compiler::Kind kind, std::span<const double> params);

// Distance to a piece, at least 0. If the radii differ, the piece must be a whole ellipse.
double distance_to(const Piece& piece, glm::dvec2 p);

double judge_outline(compiler::Kind kind, std::span<const double> params, glm::dvec2 p);

// Distance to the outline moved by `offset` along x and revolved about the y axis, at a point of the half-plane x >=
// 0. Straight edges on the axis or beyond it are not part of the surface. Curved pieces count as a whole.
double judge_turned_outline(compiler::Kind kind, std::span<const double> params, double offset, glm::dvec2 p);

// Part of a straight edge at x > 0; nullopt when no part is.
std::optional<Piece> beside_axis(const Piece& edge);

}  // namespace fathom::test
