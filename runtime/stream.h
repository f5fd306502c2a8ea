// A marcher that moves all its rays on together, in float or double, by the method of its rules.
// Tested by: tests/runtime/march_test.cpp
#pragma once

#include <array>
#include <memory>

#include "runtime/lanes.h"
#include "runtime/march.h"

namespace fathom::runtime {

template <class S>
class Stream final : public Marcher {
 public:
  Stream(const Field& field, const Marching& marching);
  void advance() override;

 private:
  static_assert(Lanes<S>::kCapacity == kCapacity);

  void begin(const Course& course, int side, float slope) override;
  void close_holes();
  void evaluate();
  void finish(std::size_t lane);
  Stretch what_is_left(std::size_t lane) const;

  LaneRules<S> rules_;
  std::unique_ptr<Lanes<S>> lanes_;
  const std::size_t register_lanes_;               // points the field is evaluated for at once, at least
  std::array<Course, kCapacity> courses_;          // [lane]
  alignas(64) std::array<S, kCapacity> distance_;  // [lane]
  std::vector<std::size_t> holes_;  // lanes whose ray has ended, downwards; a new ray or the last lane fills them
  std::size_t lanes_used_ = 0;      // with the holes
};

}  // namespace fathom::runtime
