// The rays of one thread that are under way: a marcher for the scene's field, and one for the field of each medium
// that a ray was in.
//
//     RayQueues queues(context);
//     queues.add(field, id, ray);
//     if (queues.is_due(field) && queues.advance(field)) queues.take_ray_hits(field, ray_hits);
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/base/stage_clock.h"
#include "runtime/base/stats.h"
#include "runtime/march/march.h"
#include "runtime/path/render_context.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

class RayQueues {
 public:
  explicit RayQueues(const RenderContext& context);

  // Maximum number of paths with a ray under way each. Every marcher has room for all of them.
  std::size_t capacity() const { return capacity_; }
  // Number of fields. Fields are numbered as MediumState::field has it.
  std::size_t fields() const { return marchers_.size(); }

  void add(std::size_t field, std::uint32_t id, const Ray& ray) { marcher(field).add(id, ray); }
  // True if no ray is under way and no result is left.
  bool is_idle() const;
  // True if the field's rays are to be advanced now. Rays within a medium wait until they fill registers, or until
  // there are no other rays.
  bool is_due(std::size_t field) const;
  // Evaluates the field once for each of its rays. Returns true if there are results enough for the next stages.
  bool advance(std::size_t field);
  void take_ray_hits(std::size_t field, std::vector<RayHit>& out) { marchers_[field]->take_ray_hits(out); }

  vm::Workspace& workspace(std::size_t field) { return marchers_[field]->workspace(); }
  StageClock& clock() { return marchers_[0]->clock(); }
  // Adds the counts of all marchers.
  void count(MarchCounters& counters) const;
  StageSeconds stages() const { return marchers_[0]->clock().seconds(); }

 private:
  // A marcher is made when the first ray is in its field: it takes 300 KB, and a scene may have thousands of media.
  Marcher& marcher(std::size_t field) {
    if (!marchers_[field]) [[unlikely]]
      marchers_[field] = make_marcher(context_.field_at(field), context_.settings.marching);
    return *marchers_[field];
  }

  const RenderContext& context_;
  std::vector<std::unique_ptr<Marcher>> marchers_;  // [field]
  std::size_t capacity_;
};

}  // namespace fathom::runtime
