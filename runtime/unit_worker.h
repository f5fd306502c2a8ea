// One thread's work on a render: takes units, has their paths followed, and hands each in when its last path ended.
//
// Paths of a stream end in no order, so that a few units are open at once.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/path/integrator.h"
#include "runtime/shared_picture.h"
#include "runtime/units.h"

namespace fathom::runtime {

// How many samples a pass may take of each pixel: of all as many as its units say, or at most so many of each.
class SampleLimits {
 public:
  SampleLimits() = default;
  SampleLimits(PixelRect area, std::vector<int> each) : area_(area), each_(std::move(each)) {}

  std::uint32_t at(int x, int y) const {
    return each_.empty() ? ~0u : static_cast<std::uint32_t>(each_[area_.index(x, y)]);
  }

 private:
  PixelRect area_;
  std::vector<int> each_;  // [y][x]; empty: no limits
};

// What the threads of one pass share.
struct PassWork {
  const RenderContext& context;
  Pass pass;
  std::size_t stage;  // of the film
  const SampleLimits& limits;
  UnitQueue& units;
  SharedPicture& picture;
};

class UnitWorker : private PathSource, private SampleSink {
 public:
  explicit UnitWorker(const PassWork& work) : work_(work), integrator_(work.context, work.pass, *this, *this) {}

  void run() { integrator_.run(); }
  Stats stats() const;

 private:
  struct OpenUnit {
    SampleBlock block;
    Film film;
    std::uint64_t begun = 0, ended = 0;  // paths
    bool all_begun = false;
  };

  std::size_t next(std::span<PathKey> keys) override;
  bool add(const PathKey& key, const PathSample& sample) override;
  bool next_pixel();
  bool next_unit();
  void hand_in(std::uint32_t number);

  const PassWork& work_;
  std::vector<OpenUnit> open_;       // [PathKey::unit]
  std::vector<std::uint32_t> free_;  // places in it
  bool taking_ = false;              // paths are being taken from open_[unit_]
  std::uint32_t unit_ = 0;
  int x_ = 0, y_ = 0;
  std::uint32_t sample_ = 0, end_ = 0;  // of the pixel
  std::uint64_t reported_rays_ = 0, full_sums_ = 0;
  Integrator integrator_;
};

}  // namespace fathom::runtime
