#include "runtime/unit_worker.h"

#include <algorithm>
#include <glm/common.hpp>

#include "runtime/base/color.h"

namespace fathom::runtime {
namespace {

// Returns the sample with its radiance scaled to at most `max` in magnitude. Filters may have negative weights.
PathSample clamped(PathSample sample, float max) {
  const float brightest = max_component(glm::abs(sample.radiance));
  if (brightest > max) sample.radiance *= max / brightest;
  return sample;
}

}  // namespace

std::size_t UnitWorker::next(std::span<PathKey> keys) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    while (!taking_ || sample_ >= end_) {
      if (!next_pixel()) return i;
    }
    keys[i] = {x_, y_, sample_++, unit_};
    ++open_[unit_].begun;
  }
  return keys.size();
}

bool UnitWorker::next_pixel() {
  if (taking_) {
    const PixelRect area = open_[unit_].block.area;
    if (++x_ == area.x1) {
      x_ = area.x0;
      ++y_;
    }
    if (y_ == area.y1) {
      taking_ = false;
      open_[unit_].all_begun = true;
      if (open_[unit_].ended == open_[unit_].begun) submit_unit(unit_);
    }
  }
  if (!taking_ && !next_unit()) return false;
  const SampleRange samples = open_[unit_].block.samples;
  sample_ = samples.first;
  end_ = std::min(samples.last, work_.limits.at(x_, y_));
  return true;
}

bool UnitWorker::next_unit() {
  const auto block = work_.units.take();
  if (!block) return false;
  const bool first = work_.stage == 0 && block->samples.first == work_.context.settings.samples.first;
  if (work_.shared_film.should_stop(first)) return false;
  if (free_.empty()) {
    free_.push_back(static_cast<std::uint32_t>(open_.size()));
    open_.push_back({{}, Film({}, work_.context.settings.layers)});
  }
  unit_ = free_.back();
  free_.pop_back();
  OpenUnit& unit = open_[unit_];
  unit.block = *block;
  unit.film.restart(block->area);
  unit.begun = unit.ended = 0;
  unit.all_begun = false;
  taking_ = true;
  x_ = block->area.x0;
  y_ = block->area.y0;
  return true;
}

bool UnitWorker::add(const PathKey& key, const PathSample& sample) {
  OpenUnit& unit = open_[key.unit];
  const std::optional<double>& max = work_.context.settings.sample_clamp;
  const bool room = max ? unit.film.add(key.x, key.y, clamped(sample, static_cast<float>(*max)))
                        : unit.film.add(key.x, key.y, sample);
  if (++unit.ended == unit.begun && unit.all_begun) submit_unit(key.unit);
  return room;
}

void UnitWorker::submit_unit(std::uint32_t number) {
  const OpenUnit& unit = open_[number];
  const std::uint64_t rays = integrator_.stats().march.rays;
  if (!work_.shared_film.add(unit.film, unit.block, work_.stage, unit.ended, rays - reported_rays_)) ++full_sums_;
  reported_rays_ = rays;
  free_.push_back(number);
}

Stats UnitWorker::stats() const {
  Stats stats = integrator_.stats();
  stats.saturated += full_sums_;
  return stats;
}

}  // namespace fathom::runtime
