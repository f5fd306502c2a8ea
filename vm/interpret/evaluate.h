// The public door of the machine: distances, gradients, surfaces and ranges of a verified program.
//
// Same bits for every instruction set, block position and count: each point's result depends on that point alone.
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

// distance[i] = f(points[i]), float32, for i in [0, count).
void evaluate_distance(const Code& program, Points points, std::size_t count, float* distance, Workspace& workspace);

// The same distances, and how far around each point the solid is convex (vm/number/convex-inl.h): with L the
// program's Lipschitz constant, at x within convex / L of the point p either f(x) >= convex - L |x - p|, or max(f, 0)
// is there what one convex function is. At least |distance|; infinite when there is nothing else.
void evaluate_convex(const Code& program, Points points, std::size_t count, float* distance, float* convex,
                     Workspace& workspace);

// What is known of a batch of points beside the distance; arrays of at least `count` entries.
struct SurfaceValues {
  float* distance;
  float* gradient_x;  // df/dx of the winning branch; not normalised; zero where undefined, never NaN on finite input
  float* gradient_y;
  float* gradient_z;
  std::uint32_t* surface;   // the number of the `tag` that won, 0 in a program without tags
  float* convex = nullptr;  // as of evaluate_convex; null where nobody asks
};
void evaluate_surface(const Code& program, Points points, std::size_t count, SurfaceValues out, Workspace& workspace);

struct SurfaceValue {
  double distance;
  glm::dvec3 gradient;
  std::uint32_t surface;
  double convex = 0;
};

// The same in double, with the program's unrounded constants: one point at a time or many, the same bits.
double evaluate_distance(const Code& program, glm::dvec3 point, Workspace& workspace);
void evaluate_distance(const Code& program, RealPoints points, std::size_t count, double* distance,
                       Workspace& workspace);
SurfaceValue evaluate_surface(const Code& program, glm::dvec3 point, Workspace& workspace);

// Where a surface's point lies in the coordinates of the node that the surface was given to: the `tag` that won, and
// the point on top of the stack where it stands.
struct SurfacePlace {
  std::uint32_t surface;  // the number of the `tag`, 0 in a program without tags
  glm::dvec3 place;       // the evaluated point itself in a program without tags
};
// Where two tags of one surface win equally, the first in the program counts.
SurfacePlace evaluate_place(const Code& program, glm::dvec3 point, Workspace& workspace);

struct SurfaceShare {
  std::uint32_t surface;  // the number of a `tag`
  double weight;          // above 0
  glm::dvec3 place{0};    // as of SurfacePlace; only of evaluate_placed_shares()
};
// The surfaces that have a share in a point, at most the kMost largest; their weights add up to 1. None in a program
// without tags.
struct SurfaceShares {
  static constexpr int kMost = 4;
  std::array<SurfaceShare, kMost> all;
  int count = 0;
};
// A surface's share is by how much the distance changes when that surface moves, over the sum of all: where one alone
// decides 1, along a smooth blend from 0 to 1 as Quilez's mix factor ("Smooth minimum").
SurfaceShares evaluate_shares(const Code& program, glm::dvec3 point, Workspace& workspace);
// The same with a share for each `tag` instruction and point, so that a surface can have several, each with its
// place.
SurfaceShares evaluate_placed_shares(const Code& program, glm::dvec3 point, Workspace& workspace);

struct Range {
  double lo, hi;
};

// An interval that contains f(p) for every p in the box [lo, hi] where every operation has a value, rounded outwards.
// Source: Moore, "Interval Analysis", 1966.
Range evaluate_range(const Code& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace);

// What a program does along a stretch of a line: f(origin + t direction) and its derivative by t, for t in [begin,
// end] (vm/number/along-inl.h). The derivative's range is infinite where the value may jump.
struct AlongLine {
  Range value, derivative;
};
AlongLine evaluate_along(const Code& program, glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
                         Workspace& workspace);

// Name of the instruction set in use ("avx512", "avx2", "sse4", "scalar"), and those this machine can run, best
// first. The environment variable FATHOM_ISA forces one.
std::string_view isa_name();
std::vector<std::string_view> available_isas();

// Uses `name` from here on; false (and no change) when this machine cannot run it. Not thread safe: call it before
// evaluation starts.
bool force_isa(std::string_view name);

}  // namespace fathom::vm
