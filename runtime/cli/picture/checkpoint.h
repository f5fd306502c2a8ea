// When a render's checkpoint is written, replaced and removed.
//
// One that was asked for by name is kept when the render is done, as a finished one. Else it lies beside the first
// output, is there from the first interval's end on, or when a signal or the time limit ends the render, and goes
// when the render is done. What cannot be written is reported once and tried again at the next interval; the file
// that was there stays.
//
// What would be lost with a file is never replaced: neither this very render's earlier state, nor what another run
// writes there meanwhile, nor what is no film.
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
  // `path` was `named` on the command line, or is made from an output's.
  Checkpoint(std::string path, bool named, double interval, const runtime::ReadLimits& limits)
      : path_(std::move(path)), named_(named), interval_(interval), limits_(limits) {}

  // For --resume: what there is, into `options`. An ExitCode, after a message, when it is of another render or cannot
  // be read; a note when there is none. Of the pictures that are `one_of_many` most have none, and one of another
  // render is replaced, if nobody named it.
  std::optional<ExitCode> resume(const runtime::FilmHeader& header, const runtime::Settings& settings,
                                 runtime::RenderOptions& options, const Streams& streams, bool one_of_many = false);
  // Without it. An ExitCode, after a message, when what there is could be resumed, or is no film, or, under a name of
  // the command line, anything else; a note when it will be replaced.
  std::optional<ExitCode> begin_afresh(const runtime::FilmHeader& header, const runtime::Settings& settings,
                                       const Streams& streams);
  // An ExitCode, after a message, when it cannot be written, as far as can be known.
  std::optional<ExitCode> check_path(const Streams& streams) const;

  // To be called often while the render is under way; writes when it is time.
  void tick(const runtime::FilmHeader& header, const runtime::RenderOptions::Look& look, double seconds,
            const Streams& streams);
  // Now; false, after a warning, when it cannot be done.
  bool write(const runtime::FilmHeader& header, const runtime::PartialRender& render, const Streams& streams);
  void remove(const Streams& streams);  // when it is this render's

  const std::string& path() const { return path_; }
  bool named() const { return named_; }
  // Whether there is a state of this render in it, read or written by it, and still there.
  bool holds_state() const { return ours_ && runtime::stamp_of(path_) == known_; }
  // Why it was not written the last time.
  const std::optional<std::string>& problem() const { return problem_; }
  int written() const { return written_; }

 private:
  std::optional<ExitCode> refuse_to_replace(const runtime::UnreadFilm& unread, const Streams& streams) const;
  bool replaced_by_another() const;
  std::string problem_of_another() const;
  bool save(const std::function<void(runtime::AtomicFile&)>& fill, const Streams& streams);
  std::string remedy() const;

  const std::string path_;
  const bool named_;
  const double interval_;
  const runtime::ReadLimits limits_;         // of a file that is there
  double due_ = 0;                           // seconds since the render began; 0: not known yet
  std::optional<runtime::FileStamp> known_;  // of the file as this run found it or wrote it
  bool ours_ = false;                        // that file is a state of this render
  bool warned_ = false;
  std::optional<std::string> problem_;
  int written_ = 0;
};

}  // namespace fathom::cli
