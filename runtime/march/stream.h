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

struct Pieces;

// The pieces of a template, for a stream whose rays are each in one of them.
struct PieceStream {
  const Pieces* pieces = nullptr;           // null: the stream has a field of its own
  std::uint32_t number = 0;                 // of the template
  const std::uint32_t* piece_of = nullptr;  // [ray's id]
};

template <class S>
class Stream final : public Marcher {
 public:
  static constexpr std::size_t kLanes = Lanes<S>::kCapacity;

  Stream(const Field& field, const Marching& marching, const PieceStream& source = {});

  // Starts a ray that is clipped already, if there is a free lane: less than kLanes rays are under way.
  void start(const ClippedRay& ray, int side, float slope);
  int live() const { return live_; }

 private:
  void begin(RayBlock& rays) override;
  std::size_t take_lane();
  void start_lane(std::size_t lane, int side, float slope);
  void step() override;
  void compact_lanes();
  void evaluate();
  const Field& field_of(std::size_t lane) const;
  void finish(std::size_t lane);
  RayInterval undecided_interval(std::size_t lane) const;

  const PieceStream source_;
  const bool per_lane_;  // lanes have constants of their own
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
  std::vector<float> constants_;  // [constant][lane], as evaluate_rows() takes them; only if per_lane_
  std::array<std::uint64_t, kLanes> instructions_;  // [lane] evaluated for the ray so far
};

}  // namespace fathom::runtime
