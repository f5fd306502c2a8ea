// Buffers messages until the caller knows that they are new, so that the same warnings of many frames are printed
// once.
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <sstream>
#include <string>

#include "runtime/cli/options/streams.h"

namespace fathom::cli {

class BufferedMessages {
 public:
  explicit BufferedMessages(const Streams& streams)
      : from_(streams), streams_{streams.in,    streams.out,          text_,           streams.terminal,
                                 streams.color, streams.out_terminal, streams.columns, streams.options,
                                 streams.quiet, streams.verbosity,    streams.files} {}

  BufferedMessages(const BufferedMessages&) = delete;
  ~BufferedMessages() { from_.files = streams_.files; }

  const Streams& streams() const { return streams_; }  // the streams whose messages are held

  void release() { from_.err << text_.str(); }
  // Prints the messages unless they equal `last`, and stores them in `last`.
  void release_if_new(std::string& last) {
    if (text_.str() != last) release();
    last = text_.str();
  }

 private:
  std::ostringstream text_;
  const Streams& from_;
  const Streams streams_;
};

}  // namespace fathom::cli
