// The journal of a sequence of frames: which are done, of which scene and settings, and a digest of their files. So a
// run that goes on knows which to leave as they are. A text beside the pictures, a line for each frame:
//
//     fathom frames 1
//     37 SCENE SETTINGS FILES
//
// Digests are XXH3-128 in hexadecimal. The file is replaced as a whole with each frame, whose line is put among those
// that are there by then: runs of other frames may write to it, too. Where two do so at once a line may be lost,
// which costs a frame that is rendered again.
//
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/cli/options/streams.h"
#include "runtime/cli/request/render_request.h"
#include "runtime/film/film_file.h"

namespace fathom::cli {

class FrameJournal {
 public:
  struct Entry {
    std::string scene, settings, files;
    bool operator==(const Entry&) const = default;
  };

  // Beside the first output: "frames/hop.png" -> "frames/hop.frames".
  static std::string path_beside(const std::string& output);

  explicit FrameJournal(std::string path) : path_(std::move(path)) {}

  // An ExitCode, after a message, when what is there is no journal.
  std::optional<ExitCode> read(const Streams& streams);
  bool empty() const { return entries_.empty(); }
  // Whether the frame was done as `request`, of the frame, would do it, and its files are still what they were.
  bool has(int frame, const runtime::FilmHeader& header, const RenderRequest& request) const;
  // The frame is done; the reason when that cannot be kept.
  [[nodiscard]] std::optional<std::string> add(int frame, const runtime::FilmHeader& header,
                                               const RenderRequest& request);

 private:
  std::optional<std::map<int, Entry>> parse(const std::string& text) const;

  const std::string path_;
  std::map<int, Entry> entries_;
};

}  // namespace fathom::cli
