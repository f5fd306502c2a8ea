// Progress of work whose steps are known, but not their lengths: one line that is redrawn on a terminal, and a line
// every ten seconds elsewhere. Work of less than half a second shows nothing.
//
//     meshing: contour, 12 s
//
// Tested by: tests/runtime/cli/options/step_line_test.cpp
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "runtime/cli/options/streams.h"

namespace fathom::cli {

class StepLine {
 public:
  // `work` begins every line. Nothing else may write to streams.err until end() or the destructor.
  StepLine(const Streams& streams, std::string work);
  ~StepLine() { end(); }
  StepLine(const StepLine&) = delete;
  StepLine& operator=(const StepLine&) = delete;

  void begin(std::string_view step);
  void end();  // erases the line

 private:
  using Clock = std::chrono::steady_clock;

  void run();
  void draw();

  const Streams& streams_;
  const std::string work_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable wake_;
  std::string step_;
  bool over_ = false, drawn_ = false;
  std::thread thread_;  // last, because it uses the others
};

}  // namespace fathom::cli
