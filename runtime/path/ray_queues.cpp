#include "runtime/path/ray_queues.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

// The next stages take so many results at once: a block of the machine, and half of a marcher's rays, so that the
// other half fills its lanes meanwhile.
constexpr std::size_t kResultBatch = 256;

}  // namespace

RayQueues::RayQueues(const RenderContext& context)
    : context_(context),
      marchers_(1 + context.media.size()),
      capacity_(static_cast<std::size_t>(Marcher::best_load(context.field))) {
  marcher(0);  // clock() is its
}

bool RayQueues::is_idle() const {
  return std::all_of(marchers_.begin(), marchers_.end(), [](const auto& marcher) {
    return !marcher || (marcher->empty() && marcher->ray_hits().empty());
  });
}

bool RayQueues::is_due(std::size_t field) const {
  if (field == 0) return true;
  if (!marchers_[field]) return false;
  const std::size_t rays = marchers_[field]->under_way();
  return rays > 0 && rays >= std::min(kResultBatch, marchers_[0]->under_way());
}

bool RayQueues::advance(std::size_t field) {
  Marcher& marcher = *marchers_[field];
  clock().enter(Stage::March);
  marcher.advance();
  return marcher.ray_hits().size() >= kResultBatch || marcher.empty();
}

void RayQueues::count(MarchCounters& counters) const {
  for (const auto& marcher : marchers_) {
    if (marcher) counters.merge(marcher->counters());
  }
}

}  // namespace fathom::runtime
