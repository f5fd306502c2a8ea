// How far a render is, for the person who waits: one line that is redrawn on a terminal, else a line now and then.
//
//     42 %   3.1 Mray/s   about 12 s left
//
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <string>
#include <utility>

#include "runtime/cli/options/streams.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// "12 s", "3 min 20 s", "1 h 05 min".
std::string duration(double seconds);

class ProgressLine {
 public:
  // `prefix` comes before what is said.
  explicit ProgressLine(const Streams& streams, std::string prefix = "")
      : streams_(streams), prefix_(std::move(prefix)) {}
  ~ProgressLine();  // wipes the line

  void update(const runtime::Progress& progress);
  void wipe();  // what a terminal shows of it

 private:
  bool due(const runtime::Progress& progress) const;

  const Streams& streams_;
  const std::string prefix_;
  double last_seconds_ = 0;   // when a line was last shown
  double last_fraction_ = 0;  // what it said
  bool drawn_ = false;
};

}  // namespace fathom::cli
