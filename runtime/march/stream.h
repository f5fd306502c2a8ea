// A marcher that advances all its rays together, in float or double, by the method of its rules.
// Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/march/lanes.h"
#include "runtime/march/marcher.h"
#include "runtime/march/method.h"

namespace fathom::runtime {

// Samples to accept after the first attempt to cross that met no surface.
inline constexpr double kFirstBackoff = 2;

// S is float or double.
template <class S>
LaneRules<S> make_rules(const Field& field, const Marching& marching);

// Returns the part of a lane's ray that float has not decided. If float knows a root too loosely, the search begins
// with the bracket, widened by the uncertainty.
template <class S>
RayInterval undecided_interval(const Lanes<S>& lanes, std::size_t lane, double length, float band);

template <class S>
class Stream final : public Marcher {
 public:
  Stream(const Field& field, const Marching& marching);

 private:
  static constexpr std::size_t kLanes = Lanes<S>::kCapacity;

  void begin(RayBlock& rays) override;
  void start_lane(const RayBlock& rays, std::size_t i);
  void step() override;
  void compact_lanes();
  void evaluate();
  void finish(std::size_t lane);
  RayInterval undecided_interval(std::size_t lane) const;

  LaneRules<S> rules_;
  std::unique_ptr<Lanes<S>> lanes_;
  const bool uses_epsilon_;      // the method is a baseline method, for which a hit is as wide as epsilon
  const bool takes_slope_hint_;  // rays begin with Ray::slope, unlike those of the baseline methods
  const int max_lanes_;          // maximum number in use
  const bool use_convexity_;
  const std::size_t register_lanes_;             // points per register; each evaluation fills whole registers
  std::array<ClippedRay, kLanes> clipped_rays_;  // [lane]
  alignas(64) std::array<S, kLanes> distance_;   // [lane]
  alignas(64) std::array<S, kLanes> convex_;     // [lane]; only if use_convexity_
  // Lanes whose ray has ended, in descending order. A new ray or the last lane fills them.
  std::vector<std::size_t> free_lanes_;
  std::size_t lanes_used_ = 0;  // including the free ones
  RegionScratch scratch_;
  std::array<std::uint64_t, kLanes> instructions_;  // [lane] evaluated for the ray so far
};

}  // namespace fathom::runtime
