// What the compiler knows of a node: where it can be solid, how fast its distance changes, how far to trust it.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "compiler/geometry/box.h"

namespace fathom::compiler {

// How far a distance can be trusted. Exact implies bound; a bound never exceeds the true distance.
enum class Exactness { Exact, Bound, Estimate };

// A node's value f divided by `lipschitz` is its distance: a twisted node's value may change faster than the way
// walked, and is brought back where it is combined with others (passes/level.cpp) or marched.
struct Knowledge {
  Box box;               // the distance is positive outside it
  double lipschitz = 1;  // |f(p) - f(q)| <= lipschitz |p - q|, where certified
  Exactness outside = Exactness::Exact, inside = Exactness::Exact;
  bool certified = true;
  // f(p) >= reach_max * (largest per-axis distance from the box) and f(p) >= reach * (Euclidean distance from the
  // box): how far an offset by r can move the surface out of the box, r / reach_max. Per-axis distances survive
  // intersection, Euclidean ones rotation; reach <= reach_max <= sqrt 3 reach whenever both are known.
  double reach_max = 1, reach = 1;
  // Near the surface at p, evaluating f meets no coordinate or distance larger than |p| + magnitude, scene units: its
  // float error is at most 10 * 2^-24 * (max(1, |p|, |f|) + magnitude). Large where large numbers cancel: a ball of
  // radius 1000 whose top is the ground, a group moved far away and back.
  double magnitude = 0;
  // f(p) = f(p mirrored in the plane through the origin across this axis), for x, y, z.
  std::array<bool, 3> symmetric = {false, false, false};
};

// e.g. "bound [-1,1]x[-1,1.5]x[-1,1], exact outside, Lipschitz <= 1 (proved)".
std::string describe(const Knowledge& knowledge);

// e.g. "[-1,1]x[-1,1.5]x[-1,1]", or "empty".
std::string describe(const Box& box);

// "exact", "a lower bound", "an estimate".
std::string_view name(Exactness exactness);

}  // namespace fathom::compiler
