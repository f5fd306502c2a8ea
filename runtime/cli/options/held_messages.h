// Messages that wait until it is known whether they are news: of frame after frame the same warnings are said once.
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <ostream>
#include <sstream>
#include <string>

#include "runtime/cli/options/streams.h"

namespace fathom::cli {

class HeldMessages {
 public:
  explicit HeldMessages(const Streams& streams)
      : to_(streams.err), streams_{streams.in,    streams.out,          text_,           streams.terminal,
                                   streams.color, streams.out_terminal, streams.columns, streams.options,
                                   streams.quiet, streams.verbosity} {}

  const Streams& streams() const { return streams_; }  // to be written to

  void release() { to_ << text_.str(); }
  // Unless they are `last`, which they become.
  void release_news(std::string& last) {
    if (text_.str() != last) release();
    last = text_.str();
  }

 private:
  std::ostringstream text_;
  std::ostream& to_;
  const Streams streams_;
};

}  // namespace fathom::cli
