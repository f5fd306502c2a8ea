// One thread's work on a render: takes units, has the integrator follow their paths, and adds each unit to the image
// when the unit's last path has ended. A unit whose paths are abandoned is not added.
//
// The paths of a stream end in any order, so a few units are open at once.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "runtime/path/integrator.h"
#include "runtime/shared_film.h"
#include "runtime/units.h"

namespace fathom::runtime {

// Max samples per pixel of a pass. Without limits a pass takes all samples of its units.
class SampleLimits {
 public:
  SampleLimits() = default;
  SampleLimits(PixelRect area, std::vector<std::uint32_t> each) : area_(area), each_(std::move(each)) {}

  std::uint32_t at(int x, int y) const { return each_.empty() ? ~0u : each_[area_.index(x, y)]; }
  std::uint64_t sum() const { return std::accumulate(each_.begin(), each_.end(), std::uint64_t{0}); }

 private:
  PixelRect area_;
  std::vector<std::uint32_t> each_;  // [y][x]; empty: no limits
};

// Data that the threads of one pass share.
struct PassWork {
  const RenderContext& context;
  std::size_t stage;  // stage of the film
  const SampleLimits& limits;
  UnitQueue& units;
  SharedFilm& shared_film;
};

class UnitWorker : private PathSource, private SampleSink {
 public:
  explicit UnitWorker(const PassWork& work) : work_(work), integrator_(work.context, *this, *this) {}

  void run() { integrator_.run(); }
  Stats stats() const;

 private:
  struct OpenUnit {
    SampleBlock block;
    Film film;
    std::uint64_t begun = 0, ended = 0;  // numbers of paths
    bool all_begun = false;
  };

  std::size_t next(std::span<PathKey> keys) override;
  bool add(const PathKey& key, const PathSample& sample) override;
  bool is_abandoned() override { return work_.shared_film.is_late(); }
  bool next_pixel();
  bool next_unit();
  void submit_unit(std::uint32_t number);

  const PassWork& work_;
  std::vector<OpenUnit> open_;       // [PathKey::unit]
  std::vector<std::uint32_t> free_;  // unused indices of open_
  bool taking_ = false;              // true while next() takes paths from open_[unit_]
  std::uint32_t unit_ = 0;
  int x_ = 0, y_ = 0;
  std::uint32_t sample_ = 0, end_ = 0;  // of the pixel (x_, y_): next sample, and the end
  std::uint64_t reported_rays_ = 0, full_sums_ = 0;
  Integrator integrator_;
};

}  // namespace fathom::runtime
