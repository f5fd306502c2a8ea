// Marching: rays -> the first surface they meet.
//
// A ray is followed along g(t) = side * f(origin + t direction), which is positive in the space it travels through
// (side is -1 inside a solid). A hit is a change of sign bracketed to float resolution, never "f is small". Three
// tiers:
//
//   clip    in double: the ray restarts where it enters the scene's bound, so that float t stays small
//   stream  in float, many rays at once: steps certified by the Lipschitz constant, stretched by automatic relaxation
//           (Ban and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", Eurographics 2023); near the
//           surface a step that should cross it; then the bracket shrinks by the Illinois method (march_lane.h)
//   certify in double, one ray at a time: the few that float cannot decide (certify.h)
//
// Every ray ends as Hit, Miss or Invalid; none runs out of steps.
//
//     Stream stream(field);
//     stream.add(id, ray);            // as long as there is room()
//     stream.advance();               // one evaluation of the field for every ray
//     stream.take_arrivals(arrivals);  // those that ended since the last time
//
// What becomes of a ray depends on nothing but the ray and the field. Tested by: tests/runtime/march_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "runtime/field.h"
#include "runtime/march_lane.h"
#include "runtime/stats.h"
#include "vm/evaluate.h"

namespace fathom::runtime {

struct Ray {
  glm::dvec3 origin;     // scene units
  glm::dvec3 direction;  // any finite length but zero; normalised unless it has unit length already
  double t_max = std::numeric_limits<double>::infinity();  // scene units, beside the field's `far`
  int side = 0;                                            // +1 starts outside, -1 inside a solid; 0: find out
  float slope = -1;  // dg/dt expected at the origin in [-1,1]: dot(normal, direction) when it leaves a surface
};

struct Arrival {
  enum class Status : std::uint8_t { Hit, Miss, Invalid };
  std::uint32_t id;
  Status status;
  std::int8_t side;  // of the space the ray travelled through, +1 or -1
  double t;          // of the hit, scene units from the origin
  float width;       // of the bracket round the hit, scene units
};

class Stream {
 public:
  static constexpr int kCapacity = 256;  // two blocks of the machine

  explicit Stream(const Field& field) : field_(field) {}

  int room() const { return kCapacity - live_; }
  bool empty() const { return live_ == 0; }

  // Needs room. The arrival may be there at once (a ray past the bound, or an invalid one).
  void add(std::uint32_t id, const Ray& ray);
  void advance();

  const std::vector<Arrival>& arrivals() const { return arrivals_; }
  // Moves them into `out`, in place of what it held.
  void take_arrivals(std::vector<Arrival>& out) {
    out.swap(arrivals_);
    arrivals_.clear();
  }
  const MarchCounters& counters() const { return counters_; }
  vm::Workspace& workspace() { return workspace_; }

 private:
  // What a lane does not need at every step.
  struct Course {
    glm::dvec3 origin;     // of the lane's t: where the ray enters the bound
    glm::dvec3 direction;  // unit length
    double entry;          // distance from the ray's origin to there
    std::uint32_t id;
  };

  void place_points();
  void finish(int lane, LaneVerdict verdict);
  void arrive(std::uint32_t id, Arrival::Status status, float side, double t = 0, double width = 0);
  void certify_lane(const Lane& lane, const Course& course);

  const Field& field_;
  int live_ = 0;
  std::array<Lane, kCapacity> lanes_;
  std::array<Course, kCapacity> courses_;
  alignas(64) std::array<float, kCapacity> x_, y_, z_, distance_;  // [lane]
  std::vector<Arrival> arrivals_;
  MarchCounters counters_;
  vm::Workspace workspace_;
};

// All of `rays`, in order: arrivals[i].id == i.
struct MarchResult {
  std::vector<Arrival> arrivals;
  MarchCounters counters;
};
MarchResult march(const Field& field, std::span<const Ray> rays);

}  // namespace fathom::runtime
