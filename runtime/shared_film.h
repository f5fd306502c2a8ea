// The image that the threads of a render add their units to, and that other threads may read meanwhile.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>

#include "runtime/base/stats.h"
#include "runtime/film/partial_render.h"
#include "runtime/path/options.h"

namespace fathom::runtime {

class SharedFilm {
 public:
  using Clock = std::chrono::steady_clock;

  // `samples` is the number of samples of the whole render. seconds() counts from `start`.
  SharedFilm(PartialRender& render, std::uint64_t samples, const RenderOptions& options, Clock::time_point start);

  // Adds a finished unit to a stage of the film: `film` holds the unit's sums over `samples` samples, which took
  // `rays` rays. Returns false if a sum was clamped.
  bool add(const Film& film, const SampleBlock& unit, std::size_t stage, std::uint64_t samples, std::uint64_t rays);

  // Calls `use` with the render so far. Threads that call add() wait until `use` returns.
  void read(const std::function<void(const PartialRender&)>& use);

  // Calls `make`, which may change the render: no other thread adds to the render or reads it meanwhile.
  void modify(const std::function<void()>& make);

  // Sets the number of samples left, once the render itself has decided the number. Call within modify().
  void set_remaining(std::uint64_t left);

  // True if the render has to stop; end() is then the reason. Call before beginning more work. `first` says that the
  // work is the first samples of pixels: no time limit holds for these, because there is no image without them.
  bool should_stop(bool first = false);
  // True from kGraceSeconds after the render had to stop: units under way are abandoned then, and first samples, too.
  bool is_late();
  RenderEnd end() const { return end_; }
  double seconds() const;

 private:
  static constexpr double kGraceSeconds = 1;

  void report() const;  // calls on_progress; the mutex must be locked

  PartialRender& render_;
  const RenderOptions& options_;
  double samples_;
  const std::uint64_t resumed_;
  const Clock::time_point start_;
  std::atomic<RenderEnd> end_ = RenderEnd::Done;
  std::atomic<double> cancelled_at_ = std::numeric_limits<double>::infinity();  // seconds()
  std::mutex mutex_;
  std::uint64_t done_ = 0, rays_ = 0;
};

}  // namespace fathom::runtime
