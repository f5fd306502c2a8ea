// Outlines for the judge: the boundary as explicit segments and arcs, and whether a point is inside by the shape's
// definition. The distance is that to the nearest piece of all. Slow, obvious; folds nothing, unlike the machine.
// Tested by: tests/compiler/shapes/shapes_test.cpp (against tests/support/judge/brute_force_outlines.h)
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"

namespace fathom::test {

// A straight line from `a` to `b`, or the part of an ellipse about `centre`, axes along x and y, between two angles
// from +x towards +y: centre + (radii.x cos t, radii.y sin t).
struct Piece {
  bool straight;
  glm::dvec2 a, b;
  glm::dvec2 centre, radii;
  double from, to;  // radians, from < to <= from + 2 pi
};

// In no particular order; pieces meet in their ends only.
std::vector<Piece> outline_boundary(compiler::Kind kind, std::span<const double> params);

// Distance from a piece, at least 0. Only whole ellipses are supported unless both radii are equal.
double distance_to(const Piece& piece, glm::dvec2 p);

double judge_outline(compiler::Kind kind, std::span<const double> params, glm::dvec2 p);

// The outline moved by `offset` along x and turned about the y axis, at a point of the half-plane x >= 0. Straight
// edges on the axis or beyond are no surface; curved pieces count as a whole.
double judge_turned_outline(compiler::Kind kind, std::span<const double> params, double offset, glm::dvec2 p);

// The part of a straight edge at x > 0; nullopt when there is none.
std::optional<Piece> beside_axis(const Piece& edge);

}  // namespace fathom::test
