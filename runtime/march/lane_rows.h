// Many rays on their way, one array for each quantity. A ray that is under way has a lane, the same place in every
// array; lanes.h moves them on.
//
// A lane that walks was at t with g(t) = side * f > 0 and waits for the field at t_next:
//
//   Start --> Walk <--> Retreat        Retreat: the last step was too long; the plain safe one is under way
//     |        |  |                    Cross: as Walk, by a step that is meant to cross the surface
//   Emerge     |  Refine --> Hit       Refine: a crossing lies in [t, t_hi]
//              Miss, Certify           Emerge: began on the wrong side of the surface, by rounding
//
// Not a public header: march.h is. Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/march/method.h"

namespace fathom::runtime {

enum class LaneVerdict : std::uint8_t { Going, Hit, Miss, Invalid, Certify, OutOfSteps };
enum class LanePhase : std::uint8_t { Start, Emerge, Walk, Cross, Retreat, Refine };

// What is kept of a lane. A step reads and writes most of it: every row costs.
enum LaneRow : std::uint8_t {
  // Where the field is evaluated next.
  kX,
  kY,
  kZ,
  // The ray: where t = 0, its direction of unit length, and where it ends.
  kOx,
  kOy,
  kOz,
  kDx,
  kDy,
  kDz,
  kTMax,
  kSide,   // 0 until the first evaluation when it has to be found out
  kPhase,  // a LanePhase
  kTNext,  // of kX, kY, kZ
  kEvaluations,
  kVerdict,  // a LaneVerdict
  // The last accepted sample: place, value, and safe radius: nothing lies within [t, t + r). Not set before the first
  // is.
  kT,
  kG,
  kR,
  kM,         // relaxation: expected slope of the safe radius along the ray
  kPatience,  // samples to accept before the next attempt to cross
  kPenalty,   // patience after the next attempt that meets no surface; of FixedStep: above 1 once a step was too long
  kLaneRows,
  // While refining these rows hold the bracket: its ends, the values the secant takes for both, how long the first
  // bracket was and what g falls by over it.
  kTLo = kT,
  kGLo = kG,
  kSpan = kR,
  kFall = kM,
  kTHi = kPatience,
  kGHi = kPenalty,
  // Once hit: the root, and how wide its bracket is.
  kRoot = kT,
  kWidth = kR
};

// S: float or double. Counts and flags are numbers of that type, too: a register holds as many of each.
template <class S>
struct Lanes {
  static constexpr std::size_t kCapacity = 768;
  // A line of the cache longer than need be: rows a power of two apart would all compete for the same few lines.
  static constexpr std::size_t kStride = kCapacity + 64 / sizeof(S);
  alignas(64) S row[kLaneRows][kStride];
};

// What the lanes must know of the field and the method, in the lanes' precision.
template <class S>
struct LaneRules {
  S lipschitz, inv_lipschitz;
  S band;        // near the surface: distances at which a crossing is tried, scene units
  S magnitude;   // scene units (compiler/shapes/bounds.h)
  S unit;        // d_f at unit scale
  S resolution;  // relative width of a bracket that is done
  Method method;
  S epsilon, steps, relaxation;  // of the methods that have them
};

}  // namespace fathom::runtime
