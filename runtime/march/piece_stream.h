// The rays that are in pieces of one template, advanced together in float. A piece with regions or with bounds in
// cells has a stream of its own instead (stream.h).
// Not a public header: march.h is. Tested by: tests/runtime/march/piece_marcher_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "runtime/base/stats.h"
#include "runtime/field/pieces.h"
#include "runtime/march/certified_search.h"
#include "runtime/march/lanes.h"
#include "runtime/march/method.h"
#include "vm/interpret/workspace.h"

namespace fathom::runtime {

class PieceStream {
 public:
  static constexpr std::size_t kLanes = Lanes<float>::kCapacity;

  // `number`: of the template.
  PieceStream(const Pieces& pieces, std::uint32_t number, const Marching& marching);

  std::size_t live() const { return live_; }
  // Starts the ray of this number in a piece, on this side of its surface: the ray's part from `begin` to `end`,
  // distances from its origin. Requires live() < kLanes.
  void start(std::uint32_t ray, std::int32_t piece, glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
             int side, float slope);

  // A ray that has ended, with distances from where its part begins.
  struct Ended {
    std::uint32_t ray;
    LaneVerdict verdict;
    float root, width;
    std::uint32_t evaluations;
    RayInterval rest;  // what is left of the ray, if the verdict is Certify
  };
  // Advances the rays, at least once, until fewer than `few` are left or it has taken thousands of evaluations.
  // Appends those that end to `ended`.
  void advance(std::size_t few, std::vector<Ended>& ended, MarchCounters& counters, vm::Workspace& workspace);

 private:
  void compact_lanes();
  Ended finish(std::size_t lane, MarchCounters& counters);

  const Pieces& pieces_;
  const PieceTemplate& template_;
  const LaneRules<float> rules_;
  const std::size_t register_lanes_;  // points per register; each evaluation fills whole registers
  std::unique_ptr<Lanes<float>> lanes_;
  std::array<std::uint32_t, kLanes> ray_;           // [lane]
  alignas(64) std::array<float, kLanes> distance_;  // [lane]
  alignas(64) std::array<float, kLanes> convex_;    // [lane] convexity radius: infinite
  std::vector<float> constants_;  // [constant][lane], as evaluate_rows() takes them; only if lanes have their own
  std::size_t live_ = 0;
  // Lanes whose ray has ended, in descending order. A new ray or the last lane fills them.
  std::vector<std::size_t> free_lanes_;
  std::size_t lanes_used_ = 0;  // including the free ones
  RegionScratch scratch_;
};

}  // namespace fathom::runtime
