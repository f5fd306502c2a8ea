// The state of many rays under way, one array per quantity. Each such ray has a lane, which is the same index in
// every array. lanes.h advances the lanes.
//
// A walking lane was at t with g(t) = side * f > 0 and waits for the field at t_next:
//
//   Start --> Walk <--> Retreat        Retreat: the last step was too long, and the plain safe step is under way
//     |        |  |                    Cross: like Walk, by a step meant to cross the surface
//   Emerge     |  Refine --> Hit       Refine: a crossing lies in [t, t_hi]
//              Miss, Certify           Emerge: the ray began on the wrong side of the surface, by rounding
//
// Not a public header: march.h is. Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/march/method.h"

namespace fathom::runtime {

enum class LaneVerdict : std::uint8_t { Active, Hit, Miss, Invalid, Certify, OutOfSteps };
enum class LanePhase : std::uint8_t { Start, Emerge, Walk, Cross, Retreat, Refine };

// The rows of a lane's state. Every row costs time, because a step reads and writes most rows. So the last rows, from
// kT on, have several meanings, each with its own enum: LaneRow while the lane walks, BracketRow in the phase Refine,
// HitRow after a hit.
enum LaneRow : std::uint8_t {
  // Point at which the field is evaluated next.
  kX,
  kY,
  kZ,
  // The ray: its origin, where t = 0, its unit direction, and its end.
  kOx,
  kOy,
  kOz,
  kDx,
  kDy,
  kDz,
  kTMax,
  kBefore,  // way of the ray to that origin: what a root's error is relative to
  // 0 until the first evaluation if the ray's side is unknown.
  kSide,
  kPhase,  // a LanePhase
  kTNext,  // t of the point kX, kY, kZ
  kEvaluations,
  kVerdict,  // a LaneVerdict
  // The last accepted sample: t, g, and the safe radius r. No surface lies within [t, t + r). Unset before the first
  // accepted sample.
  kT,
  kG,
  kR,
  kM,             // relaxation: expected slope of the safe radius along the ray
  kBackoffCount,  // samples to accept before the next attempt to cross
  kBackoff,       // kBackoffCount after the next attempt that meets no surface
  kLaneRows
};
// The bracket of a lane that refines.
enum BracketRow : std::uint8_t {
  kTLo = kT,  // t of its ends
  kTHi = kBackoffCount,
  kGLo = kG,  // values that the secant uses for the ends
  kGHi = kBackoff,
  kSpan = kR,  // length of the first bracket
  kFall = kM   // fall of g over the first bracket
};
// The bracket of a hit: the root in it, and its width.
enum HitRow : std::uint8_t { kRoot = kT, kWidth = kR };
// The baseline method FixedStep: above 1 once a step was too long.
enum FixedStepRow : std::uint8_t { kOverstepped = kBackoff };

inline constexpr std::size_t kSharedRows = kLaneRows - kT;  // rows with several meanings
static_assert(int{kTLo} == int{kT} && int{kGLo} == int{kG}, "a bracket begins at the last accepted sample");
static_assert(int{kRoot} == int{kT}, "the root of a baseline method is the last accepted sample");

// S is float or double. Counts and flags have that type, too, so that a register holds the same number of each.
template <class S>
struct Lanes {
  static constexpr std::size_t kCapacity = 768;
  // A cache line longer than needed: rows a power of two apart would all compete for the same few cache lines.
  static constexpr std::size_t kStride = kCapacity + 64 / sizeof(S);
  alignas(64) S row[kLaneRows][kStride];
};

// Constants of the field and the method, in the lanes' precision.
template <class S>
struct LaneRules {
  S lipschitz, inv_lipschitz;
  S band;        // distance below which a lane tries to cross the surface, scene units
  S cancellation;  // size of the numbers that cancel, scene units (compiler/shapes/bounds.h)
  S unit;        // d_f at unit scale
  S resolution;  // relative width at which a bracket is done
  Method method;
  S epsilon, steps, relaxation;  // of the methods that use them
};

}  // namespace fathom::runtime
