// Where the time of a render goes: a clock that charges what passes to the stage under way.
//
// A stage is entered for a batch of rays, not for each ray: reading the clock takes as long as a few field
// evaluations. A clock that was not started reads nothing. One per thread.
//
//     clock.start(Stage::March);
//     clock.enter(Stage::Normals);   // what passed until here was marching
//     clock.stop();
//
// Tested by: tests/runtime/base/stats_test.cpp
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <iterator>

namespace fathom::runtime {

enum class Stage : std::uint8_t { March, Resolve, Normals, Shading, Film };

// In the order of the enum.
inline constexpr const char* kStages[] = {
    "march",    // rays moved on together
    "resolve",  // the search in double (certify.h)
    "normals",  // surfaces at the hits
    "shading",  // materials, and the rays that set out
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

  // Ends the stage under way, which is returned.
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
