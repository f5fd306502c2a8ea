// When a render's checkpoint is written, replaced and removed.
//
// One that was asked for by name is kept when the render is done, as a finished one. Else it lies beside the first
// output, is there only from the first interval's end on, and goes when the pictures are written. What cannot be
// written is reported once and tried again at the next interval; the file that was there stays.
//
// Tested by: tests/runtime/cli_checkpoint_test.cpp
#pragma once

#include <optional>
#include <string>

#include "runtime/cli/streams.h"
#include "runtime/film_file.h"
#include "runtime/options.h"

namespace fathom::cli {

inline constexpr double kCheckpointInterval = 60;  // seconds
inline constexpr const char* kCheckpointEnding = ".checkpoint";

class Checkpoint {
 public:
  // `path` was `named` on the command line, or is made from an output's.
  Checkpoint(std::string path, bool named, double interval)
      : path_(std::move(path)), named_(named), interval_(interval) {}

  // For --resume: what there is, into `options`. An ExitCode, after a message, when it is of another render or cannot
  // be read; a note when there is none.
  std::optional<ExitCode> resume(const runtime::FilmHeader& header, const runtime::Settings& settings,
                                 runtime::RenderOptions& options, const Streams& streams);
  // Without it: a note when an earlier one would be replaced. An ExitCode, after a message, when the file is
  // something else.
  std::optional<ExitCode> begin_afresh(const Streams& streams);
  // An ExitCode, after a message, when it cannot be written, as far as can be known.
  std::optional<ExitCode> check_path(const Streams& streams) const;

  // To be called often while the render is under way; writes when it is time.
  void tick(const runtime::FilmHeader& header, const runtime::RenderOptions::Look& look, double seconds,
            const Streams& streams);
  // Now; false, after a warning, when it cannot be done.
  bool write(const runtime::FilmHeader& header, const runtime::PartialRender& render, const Streams& streams);
  void remove();  // when it is this render's

  const std::string& path() const { return path_; }
  bool named() const { return named_; }
  bool is_ours() const { return ours_; }   // written or read by this render
  bool failed() const { return failed_; }  // to be written the last time
  int written() const { return written_; }

 private:
  bool commit(runtime::AtomicFile& file, const Streams& streams);

  const std::string path_;
  const bool named_;
  const double interval_;
  double due_ = 0;  // seconds since the render began; 0: not known yet
  bool ours_ = false, failed_ = false, warned_ = false;
  int written_ = 0;
};

}  // namespace fathom::cli
