// The journal of a sequence of frames: for each completed frame, digests of its scene, its settings and its files. A
// resumed run skips the frames that the journal lists. The journal is a text file next to the images with one line
// per frame:
//
//     fathom frames 1
//     37 SCENE SETTINGS FILES
//
// Digests are XXH3-128 in hexadecimal. Each completed frame re-reads the file, adds its line and replaces the file as
// a whole, so runs of other frames may share the journal. If two runs do so at the same moment, a line may be lost,
// and that frame is rendered again.
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

  // Returns the journal's path for the first output: "frames/hop.png" -> "frames/hop.frames".
  static std::string path_for(const std::string& output);

  explicit FrameJournal(std::string path) : path_(std::move(path)) {}

  // Reads the journal if it exists. Prints a message and returns an exit code if the file is not a journal.
  std::optional<ExitCode> read(const Streams& streams);
  bool empty() const { return entries_.empty(); }
  // True if the journal lists the frame with the scene and settings of `request`, and the frame's files are
  // unchanged.
  bool has(int frame, const runtime::FilmHeader& header, const RenderRequest& request) const;
  // Adds a completed frame. Returns the problem if the journal cannot be written.
  [[nodiscard]] std::optional<std::string> add(int frame, const runtime::FilmHeader& header,
                                               const RenderRequest& request);

 private:
  std::optional<std::map<int, Entry>> parse(const std::string& text) const;

  const std::string path_;
  std::map<int, Entry> entries_;
};

}  // namespace fathom::cli
