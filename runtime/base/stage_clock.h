// Splits the time of a render into stages: a clock that charges the elapsed time to the current stage.
//
// A stage is entered per batch of rays, not per ray: reading the clock takes as long as a few field evaluations. A
// clock that was not started reads no time. Each thread has one.
//
//     clock.start(Stage::March);
//     clock.enter(Stage::Normals);   // the time until here was marching
//     clock.stop();
//
// Tested by: tests/runtime/base/stats_test.cpp
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <iterator>

namespace fathom::runtime {

enum class Stage : std::uint8_t { March, Certify, Normals, Shading, Film };

// Names of the stages, in the order of the enum.
inline constexpr const char* kStages[] = {
    "march",    // rays marched together
    "certify",  // the search in double (certify.h)
    "normals",  // surfaces at the hits
    "shading",  // materials, and setting up new rays
    "film",     // paths added to their pixels
};

using StageSeconds = std::array<double, std::size(kStages)>;  // [Stage]

class StageClock {
 public:
  void start(Stage stage) {
    on_ = true;
    stage_ = stage;
    since_ = Clock::now();
  }

  // Ends the current stage and returns it.
  Stage enter(Stage next) {
    const Stage before = stage_;
    if (on_ && next != before) charge();
    stage_ = next;
    return before;
  }

  void stop() {
    if (on_) charge();
    on_ = false;
  }

  StageSeconds seconds() const {
    StageSeconds seconds;
    for (std::size_t i = 0; i < seconds.size(); ++i) seconds[i] = std::chrono::duration<double>(spent_[i]).count();
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void charge() {
    const Clock::time_point now = Clock::now();
    spent_[static_cast<std::size_t>(stage_)] += now - since_;
    since_ = now;
  }

  bool on_ = false;
  Stage stage_ = Stage::March;
  Clock::time_point since_;
  std::array<Clock::duration, std::size(kStages)> spent_{};
};

}  // namespace fathom::runtime
