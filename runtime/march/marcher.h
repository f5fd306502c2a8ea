// The base of every marcher. A marcher takes rays, clips them to the scene's bound (clip.h), advances them, searches
// some in double (certified_search.h), and returns their RayHits. A derived class advances the rays: stream.h.
//
// march.h makes the marcher of a method and shows its use. Not a public header: march.h is.
// Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <unordered_map>
#include <vector>

#include "runtime/base/stage_clock.h"
#include "runtime/base/stats.h"
#include "runtime/field/field.h"
#include "runtime/march/certified_search.h"
#include "runtime/march/clip.h"
#include "runtime/march/ray.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

class Marcher {
 public:
  // A ray clipped to the scene's bound.
  struct ClippedRay {
    glm::dvec3 origin;     // where the ray enters the bound
    glm::dvec3 direction;  // unit length
    double entry;          // distance from the ray's origin to `origin`
    double length;         // within the bound
    std::uint32_t id;
  };

  static constexpr int kMaxRays = RayBlock::kCapacity;

  explicit Marcher(const Field& field);
  virtual ~Marcher() = default;
  Marcher(const Marcher&) = delete;
  Marcher& operator=(const Marcher&) = delete;

  // Number of rays under way that is fastest: high with regions and pieces, so that many points need one template.
  static int best_load(const Field& field);
  int room() const { return static_cast<int>(max_waiting_ - waiting_.count); }
  // Number of rays under way.
  std::size_t under_way() const { return static_cast<std::size_t>(live_) + waiting_.count + searched_.size(); }
  bool empty() const { return under_way() == 0; }

  // Requires room() > 0.
  void add(std::uint32_t id, const Ray& ray) {
    if (waiting_.count >= max_waiting_) [[unlikely]]
      fail_full();
    ++counters_.rays;
    waiting_.push(id, ray);
  }
  void advance();

  const std::vector<RayHit>& ray_hits() const { return ray_hits_; }
  // Moves the results into `out` and drops the previous content of `out`.
  void take_ray_hits(std::vector<RayHit>& out) {
    out.swap(ray_hits_);
    ray_hits_.clear();
  }
  virtual MarchCounters counters() const { return counters_; }
  vm::Workspace& workspace() { return workspace_; }
  StageClock& clock() { return clock_; }  // its owner sets the stages, the marcher enters Resolve

 protected:
  // Starts clipped rays of `rays`, from the last on, as long as there is room, and removes them from the block. live_
  // counts the rays under way.
  virtual void begin(RayBlock& rays) = 0;
  // Advances the rays under way by one evaluation.
  virtual void step() = 0;

  // Copies each number on its own: a copy of the whole struct would wait for the stores that have just filled it.
  static void set_clipped_ray(ClippedRay& ray, const RayBlock& rays, std::size_t i) {
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = rays.origin[axis][i];
      ray.direction[axis] = rays.direction[axis][i];
    }
    ray.entry = rays.entry[i];
    ray.length = rays.length[i];
    ray.id = rays.id[i];
  }
  // True if the i-th of `rays` comes within the bound. Otherwise reports that it does not.
  bool enters(const RayBlock& rays, std::size_t i) {
    const ClipResult clipped = rays.clip_result(i);
    if (clipped == ClipResult::Within) return true;
    if (clipped == ClipResult::Past) ++counters_.clipped;
    report(rays.id[i], clipped == ClipResult::Past ? RayHit::Status::Miss : RayHit::Status::Invalid);
    return false;
  }
  // Adds a RayHit, constructed in place from its fields, in order. clang before 16 copies it.
  template <class... Fields>
  void report(std::uint32_t id, RayHit::Status status, Fields... fields) {
    count(status);
#ifdef __cpp_aggregate_paren_init
    ray_hits_.emplace_back(id, status, fields...);
#else
    ray_hits_.push_back(RayHit{id, status, fields...});
#endif
    if (!resumed_.empty()) [[unlikely]]
      add_work(ray_hits_.back());
    counters_.instructions += ray_hits_.back().instructions;
  }
  // Hands a ray that is no longer live to the search in double, after `evaluations` in float. If the interval ends
  // before the ray and has no hit, the ray goes on in float from there.
  void certify_from(const Field& field, const ClippedRay& ray, int side, const RayInterval& interval,
                    std::uint32_t evaluations, std::uint64_t instructions);

  const Field& field_;
  int live_ = 0;  // rays under way, without the rays added since the last advance()
  MarchCounters counters_;
  vm::Workspace workspace_;
  RealScratch real_scratch_;
  StageClock clock_;

 private:
  // By sums and not by branches, of which every other would be predicted wrong.
  void count(RayHit::Status status) {
    counters_.hits += status == RayHit::Status::Hit;
    counters_.misses += status == RayHit::Status::Miss;
    counters_.near_misses += status == RayHit::Status::NearMiss;
    counters_.invalid += status == RayHit::Status::Invalid;
  }
  // Adds the work on the ray before it went on in float.
  void add_work(RayHit& ray_hit);
  [[noreturn]] static void fail_full();
  void begin_waiting();
  void search();
  void evaluate_searches();
  void end_search(std::size_t i);

  // Work on a ray so far.
  struct Work {
    std::uint32_t evaluations = 0;  // in float
    std::uint32_t certified = 0;    // in double
    std::uint64_t instructions = 0;
  };
  // A ray that is being searched in double.
  struct SearchedRay {
    const Field* field;
    CertifiedSearch search;
    ClippedRay ray;
    double end;  // of the search: ray.length, or less if the ray then goes on in float
    Work work;
  };
  bool resume(const SearchedRay& searched);

  RayBlock waiting_;                    // the last ray begins next
  std::size_t clipped_ = 0;             // number of waiting rays that are clipped, the first ones
  std::size_t max_waiting_ = kMaxRays;  // kMaxRays, less the rays that are live or searched
  const std::size_t min_batch_;         // minimum number of rays worth a search
  std::vector<SearchedRay> searched_;
  std::unordered_map<std::uint32_t, Work> resumed_;  // [id] work on rays that went on in float after a search
  // The points of the rays in searched_, [axis][ray], and the field there, [ray].
  std::vector<double> points_[3], values_;
  std::vector<std::uint64_t> instructions_;  // [ray] instructions of the evaluation
  std::vector<RayHit> ray_hits_;
};

}  // namespace fathom::runtime
