// Public interface of the interpreter: distances, gradients, surfaces and ranges of a verified program.
//
// Results have the same bits for every instruction set, block position and count: each point's result depends on that
// point alone.
//
//     vm::Workspace workspace;                       // one per thread
//     vm::evaluate_distance(program, {x, y, z}, count, distance, workspace);
//
// Tested by: tests/vm/interpret/evaluate_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "vm/interpret/points.h"
#include "vm/interpret/workspace.h"
#include "vm/program/verify.h"

namespace fathom::vm {

// Computes distance[i] = f(points[i]) in float32 for i in [0, count).
void evaluate_distance(const Code& program, Points points, std::size_t count, float* distance, Workspace& workspace);

// Computes the same distances and each point's convexity radius `convex` (vm/number/convexity-inl.h). Let L be the
// program's Lipschitz constant. At every x within convex / L of the point p, either f(x) >= convex - L |x - p|, or
// max(f(x), 0) equals a convex function, the same for all such x. `convex` is at least |distance|, and infinite for a
// solid that is convex as a whole.
void evaluate_convex(const Code& program, Points points, std::size_t count, float* distance, float* convex,
                     Workspace& workspace);

// Results of evaluate_surface() for a batch of points; arrays of at least `count` entries.
struct SurfaceValues {
  float* distance;
  float* gradient_x;  // df/dx of the winning branch; not normalised; zero where undefined, never NaN on finite input
  float* gradient_y;
  float* gradient_z;
  std::uint32_t* surface;   // surface of the `tag` that won, 0 in a program without tags
  float* convex = nullptr;  // as in evaluate_convex(); not computed if null
};
void evaluate_surface(const Code& program, Points points, std::size_t count, SurfaceValues out, Workspace& workspace);

struct SurfaceValue {
  double distance;
  glm::dvec3 gradient;
  std::uint32_t surface;
  double convex = 0;
};

// Evaluation in double, with the program's unrounded constants. One point at a time and many give the same bits.
double evaluate_distance(const Code& program, glm::dvec3 point, Workspace& workspace);
void evaluate_distance(const Code& program, RealPoints points, std::size_t count, double* distance,
                       Workspace& workspace);
SurfaceValue evaluate_surface(const Code& program, glm::dvec3 point, Workspace& workspace);

// Position of a point in the coordinates of the node that carries its surface: the top of the point stack at the
// `tag` that won.
struct SurfacePlace {
  std::uint32_t surface;  // of the `tag`, 0 in a program without tags
  glm::dvec3 place;       // the evaluated point itself in a program without tags
};
// If two tags of one surface tie, the first in the program wins.
SurfacePlace evaluate_place(const Code& program, glm::dvec3 point, Workspace& workspace);

struct SurfaceShare {
  std::uint32_t surface;  // of a `tag`
  double weight;          // above 0
  glm::dvec3 place{0};    // as in SurfacePlace; set only by evaluate_placed_shares()
};
// Surfaces that have a share in a point: the kMost with the largest weights. The weights add up to 1. Empty in a
// program without tags.
struct SurfaceShares {
  static constexpr int kMost = 4;
  std::array<SurfaceShare, kMost> all;
  int count = 0;
};
// Computes the surfaces' shares in a point. A surface's share is the change of the distance per movement of that
// surface, divided by the sum over all surfaces. The share is 1 where one surface alone determines the distance, and
// goes from 0 to 1 along a smooth blend like Quilez's mix factor ("Smooth minimum").
SurfaceShares evaluate_shares(const Code& program, glm::dvec3 point, Workspace& workspace);
// Like evaluate_shares(), with one share per `tag` instruction and point, so that a surface can have several shares,
// each with its place.
SurfaceShares evaluate_placed_shares(const Code& program, glm::dvec3 point, Workspace& workspace);

struct Range {
  double lo, hi;
};

// Returns an interval, rounded outwards, that contains f(p) for every p in the box [lo, hi] at which every operation
// is defined. Source: Moore, "Interval Analysis", 1966.
Range evaluate_range(const Code& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace);

// Ranges along an interval of a line: of f(origin + t direction) and of its derivative by t, for t in [begin, end]
// (vm/number/along-inl.h). The derivative's range is infinite where the value may jump.
struct AlongLine {
  Range value, derivative;
};
AlongLine evaluate_along(const Code& program, glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
                         Workspace& workspace);

// Name of the instruction set in use ("avx512", "avx2", "sse4", "neon", "scalar"), and the names of all that this
// computer can run, best first. The environment variable FATHOM_ISA forces one.
std::string_view isa_name();
std::vector<std::string_view> available_isas();

// Uses the instruction set `name` from here on. Returns false, without a change, if this computer cannot run `name`.
// Not thread safe: call force_isa() before evaluation starts.
bool force_isa(std::string_view name);

}  // namespace fathom::vm
