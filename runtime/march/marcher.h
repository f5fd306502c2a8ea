// The base of every marcher: rays come in, are clipped to the scene's bound (clip.h), move on, are searched in double
// where that is needed (search.h), and have arrived. Classes derived from it move them on: stream.h.
//
// march.h makes the marcher of a method and says how one is used. Not a public header: march.h is.
// Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "runtime/base/stage_clock.h"
#include "runtime/base/stats.h"
#include "runtime/field/field.h"
#include "runtime/march/clip.h"
#include "runtime/march/ray.h"
#include "runtime/march/search.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

class Marcher {
 public:
  static constexpr int kMostRays = RayBlock::kCapacity;

  explicit Marcher(const Field& field);
  virtual ~Marcher() = default;
  Marcher(const Marcher&) = delete;
  Marcher& operator=(const Marcher&) = delete;

  // Rays under way at once, kMostRays at most: with regions many, so that many are in programs of one skeleton.
  int capacity() const { return capacity_; }
  static int capacity_for(const Field& field);
  int room() const { return capacity_ - live_ - static_cast<int>(waiting_.count + searched_.size()); }
  bool empty() const { return live_ == 0 && waiting_.count == 0 && searched_.empty(); }

  // Needs room.
  void add(std::uint32_t id, const Ray& ray) {
    if (room() <= 0) [[unlikely]]
      refuse();
    ++counters_.rays;
    waiting_.push(id, ray);
  }
  void advance();

  const std::vector<Arrival>& arrivals() const { return arrivals_; }
  // Moves them into `out`, in place of what it held.
  void take_arrivals(std::vector<Arrival>& out) {
    out.swap(arrivals_);
    arrivals_.clear();
  }
  const MarchCounters& counters() const { return counters_; }
  vm::Workspace& workspace() { return workspace_; }
  StageClock& clock() { return clock_; }  // tells Resolve from what its owner does

 protected:
  // A ray within the scene's bound.
  struct Course {
    glm::dvec3 origin;     // where the ray enters the bound
    glm::dvec3 direction;  // unit length
    double entry;          // distance from the ray's origin to there
    double length;         // within the bound
    std::uint32_t id;
  };

  // Takes up `rays`, which are clipped, from the last on as long as there is room, and takes them from the block.
  // live_ counts those that are under way.
  virtual void begin(RayBlock& rays) = 0;
  // Moves the rays under way on by one evaluation.
  virtual void step() = 0;

  // Each number on its own: of a whole that has just been put together in memory a copy has to wait.
  static void set_course(Course& course, const RayBlock& rays, std::size_t i) {
    for (int axis = 0; axis < 3; ++axis) {
      course.origin[axis] = rays.origin[axis][i];
      course.direction[axis] = rays.direction[axis][i];
    }
    course.entry = rays.entry[i];
    course.length = rays.length[i];
    course.id = rays.id[i];
  }
  // Whether the i-th of `rays` comes within the bound; one that does not has arrived.
  bool enters(const RayBlock& rays, std::size_t i) {
    const Clip fate = rays.what_became_of(i);
    if (fate == Clip::Within) return true;
    if (fate == Clip::Past) ++counters_.clipped;
    arrive(rays.id[i], fate == Clip::Past ? Arrival::Status::Miss : Arrival::Status::Invalid);
    return false;
  }
  // The fields of an Arrival, in order; it is made in its place.
  template <class... Fields>
  void arrive(std::uint32_t id, Arrival::Status status, Fields... fields) {
    count(status);
    arrivals_.emplace_back(id, status, fields...);
    counters_.instructions += arrivals_.back().instructions;
  }
  // The ray, no longer live, is to be ended by the search in double, after `evaluations` in float.
  void certify_from(const Course& course, int side, const Stretch& stretch, std::uint32_t evaluations,
                    std::uint64_t instructions);

  const Field& field_;
  const int capacity_;
  int live_ = 0;  // rays under way; those that were added since the last advance() wait
  MarchCounters counters_;
  vm::Workspace workspace_;
  RealScratch real_scratch_;
  StageClock clock_;

 private:
  void count(Arrival::Status status) {
    switch (status) {
      case Arrival::Status::Hit:
        ++counters_.hits;
        break;
      case Arrival::Status::Miss:
        ++counters_.misses;
        break;
      case Arrival::Status::Contact:
        ++counters_.contacts;
        break;
      case Arrival::Status::Invalid:
        ++counters_.invalid;
        break;
    }
  }
  [[noreturn]] static void refuse();
  void begin_waiting();
  void search();
  void search_once();
  void end_search(std::size_t i);

  // A ray that is searched in double.
  struct Searched {
    Search search;
    double entry;  // of its Course
    std::uint32_t id;
    std::uint32_t evaluations;  // in float
    std::uint64_t instructions;
  };

  RayBlock waiting_;                // the last one is the next to begin
  std::size_t clipped_ = 0;         // of those waiting, the first
  const std::size_t side_by_side_;  // rays that are worth searching
  std::vector<Searched> searched_;
  std::vector<double> question_[3], answer_;  // [axis][of searched_]
  std::vector<std::uint64_t> price_;          // instructions an answer took
  std::vector<Arrival> arrivals_;
};

}  // namespace fathom::runtime
