// Progress of a render: one line that is redrawn on a terminal, or occasional lines elsewhere.
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

// Formats a duration: "12 s", "3 min 20 s", "1 h 05 min".
std::string duration(double seconds);

class ProgressLine {
 public:
  // `prefix` begins every line.
  explicit ProgressLine(const Streams& streams, std::string prefix = "")
      : streams_(streams), prefix_(std::move(prefix)) {}
  ~ProgressLine();  // erases the line

  void update(const runtime::Progress& progress);
  void erase();  // erases the line on a terminal

 private:
  bool due(const runtime::Progress& progress) const;

  const Streams& streams_;
  const std::string prefix_;
  double last_seconds_ = 0;   // time of the last line
  double last_fraction_ = 0;  // fraction in the last line
  bool drawn_ = false;
};

}  // namespace fathom::cli
