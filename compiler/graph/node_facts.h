// Facts that the compiler knows about a node: its bounding box, its Lipschitz constant, and how far its distance can
// be trusted.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "compiler/geometry/box.h"

namespace fathom::compiler {

// How far a distance can be trusted. Exact implies Bound. A Bound never exceeds the true distance.
enum class Exactness { Exact, Bound, Estimate };

// A node's value f divided by `lipschitz` is a distance: the value of a twisted node, for one, can change faster than
// the point moves. The compiler (compiler/passes/normalise.cpp) divides where it combines such a node with others,
// the renderer where it marches.
struct NodeFacts {
  Box box;               // the distance is positive outside it
  double lipschitz = 1;  // |f(p) - f(q)| <= lipschitz |p - q| if certified
  Exactness outside = Exactness::Exact, inside = Exactness::Exact;
  bool certified = true;
  // f(p) >= reach_max * (largest per-axis distance from the box) and f(p) >= reach * (Euclidean distance from the
  // box). An offset by r moves the surface out of the box by at most r / reach_max. Per-axis distances survive
  // intersection, Euclidean ones rotation. reach <= reach_max <= sqrt 3 reach whenever both are known.
  double reach_max = 1, reach = 1;
  // Bound on the cancellation near the surface, scene units: evaluating f at p meets no coordinate or distance larger
  // than |p| + cancellation, so the float error of f is at most 10 * 2^-24 * (max(1, |p|, |f|) + cancellation). Large
  // where large numbers cancel: a ball of radius 1000 whose top is the ground, a group moved far away and back.
  double cancellation = 0;
  // f(p) = f(p mirrored in the plane through the origin across this axis), for x, y, z.
  std::array<bool, 3> symmetric = {false, false, false};
};

// Returns e.g. "bound [-1,1]x[-1,1.5]x[-1,1], exact outside, Lipschitz <= 1 (proved)".
// `in_cells`: the constant is proved cell by cell (compiler/analysis/formula_cells.h).
std::string describe(const NodeFacts& facts, bool in_cells = false);

// Returns e.g. "[-1,1]x[-1,1.5]x[-1,1]", or "empty".
std::string describe(const Box& box);

// Returns "exact", "a lower bound" or "an estimate".
std::string_view name(Exactness exactness);

}  // namespace fathom::compiler
