// Rules for writing, replacing and removing a render's checkpoint.
//
// A checkpoint named on the command line is kept, in its finished state, when the render is done. Any other
// checkpoint lies next to the first output. It is written first at the end of the first interval, or when a signal or
// the time limit ends the render, and it is removed when the render is done. A failed write is reported once and
// retried at the next interval, and the previous file stays.
//
// Three kinds of files are never replaced, because their content would be lost: an earlier state of the same render,
// a file that another run writes meanwhile, and a file that is not a film.
//
// Tested by: tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "runtime/cli/options/streams.h"
#include "runtime/film/film_file.h"
#include "runtime/path/options.h"

namespace fathom::cli {

inline constexpr double kCheckpointInterval = 60;  // seconds

class Checkpoint {
 public:
  // `named`: `path` was given on the command line, not derived from an output's name.
  Checkpoint(std::string path, bool named, double interval, const runtime::ReadLimits& limits)
      : path_(std::move(path)), named_(named), interval_(interval), limits_(limits) {}

  // For --resume: loads the checkpoint into `options`. Prints a message and returns an exit code if the checkpoint
  // belongs to another render or cannot be read. Prints a note if there is no checkpoint. `one_of_many` marks one of
  // many frames or units: most of them have no checkpoint, so there is no note, and a checkpoint of another render is
  // replaced unless its name was given on the command line.
  std::optional<ExitCode> resume(const runtime::FilmHeader& header, const runtime::Settings& settings,
                                 runtime::RenderOptions& options, const Streams& streams, bool one_of_many = false);
  // For a render without --resume. Prints a message and returns an exit code if the existing file could be resumed or
  // is not a film, or if its name was given on the command line. Prints a note if the file will be replaced.
  std::optional<ExitCode> start_new(const runtime::FilmHeader& header, const runtime::Settings& settings,
                                    const Streams& streams);
  // Prints a message and returns an exit code if the path is known in advance not to be writable.
  std::optional<ExitCode> check_path(const Streams& streams) const;

  // Writes the checkpoint if the interval is over. To be called often during the render.
  void tick(const runtime::FilmHeader& header, const runtime::RenderOptions::SnapshotReader& snapshot, double seconds,
            const Streams& streams);
  // Writes the checkpoint now. Returns false, after a warning, if the write fails.
  bool write(const runtime::FilmHeader& header, const runtime::PartialRender& render, const Streams& streams);
  void remove(const Streams& streams);  // removes only a state of this render

  const std::string& path() const { return path_; }
  bool named() const { return named_; }
  // True if the file is still the state of this render that this run read or wrote.
  bool holds_state() const { return is_own_ && runtime::stamp_of(path_) == known_; }
  // Problem of the last write, if any.
  const std::optional<std::string>& problem() const { return problem_; }
  int written() const { return written_; }

 private:
  std::optional<ExitCode> check_replaceable(const runtime::FilmReadError& read_error, const Streams& streams) const;
  bool replaced_by_another() const;
  std::string problem_of_another() const;
  bool save(const std::function<void(runtime::AtomicFile&)>& fill, const Streams& streams);
  std::string remedy() const;

  const std::string path_;
  const bool named_;
  const double interval_;
  const runtime::ReadLimits limits_;         // for reading an existing file
  double due_ = 0;                           // seconds since the render began; 0: not set yet
  std::optional<runtime::FileStamp> known_;  // the file as this run found it or wrote it
  bool is_own_ = false;                      // the known file is a state of this render
  bool warned_ = false;
  std::optional<std::string> problem_;
  int written_ = 0;
};

}  // namespace fathom::cli
