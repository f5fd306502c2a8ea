// The picture that the threads of a render add their units to, and that others may look at meanwhile.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>

#include "runtime/base/stats.h"
#include "runtime/film/partial_render.h"
#include "runtime/path/options.h"

namespace fathom::runtime {

class SharedPicture {
 public:
  using Clock = std::chrono::steady_clock;

  // `samples` is how many there are to be in all; seconds are counted from `start`.
  SharedPicture(PartialRender& render, std::uint64_t samples, const RenderOptions& options, Clock::time_point start);

  // A unit is done: its samples, of a stage of the film, were added up in `film`, by so many rays. False when some
  // sum is full.
  bool add(const Film& film, const SampleBlock& unit, std::size_t stage, std::uint64_t samples, std::uint64_t rays);

  // What there is, while all who want to add wait.
  void look(const std::function<void(const PartialRender&)>& use);

  // Does to the render what no one may look at meanwhile.
  void change(const std::function<void()>& make);

  // How many samples there are to be from now on, where that shows late; to be called within change().
  void expect(std::uint64_t left);

  // To be asked when there is more to do: whether it is to be left. That is then how the render ended. Without the
  // `first` samples of a pixel there is no picture: no time limit holds for them.
  bool stopped(bool first = false);
  RenderEnd end() const { return end_; }
  double seconds() const;

 private:
  void report() const;  // how far it is; while nobody adds

  PartialRender& render_;
  const RenderOptions& options_;
  double samples_;
  const std::uint64_t resumed_;
  const Clock::time_point start_;
  std::atomic<RenderEnd> end_ = RenderEnd::Done;
  std::mutex mutex_;
  std::uint64_t done_ = 0, rays_ = 0;
};

}  // namespace fathom::runtime
