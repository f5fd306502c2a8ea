// Renders a compiled scene to its files: resumes a checkpoint, shows progress and saves checkpoints during the
// render, and writes the results.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/file_watch.h"
#include "runtime/cli/picture/checkpoint.h"
#include "runtime/cli/picture/image_files.h"
#include "runtime/cli/picture/interruption.h"
#include "runtime/cli/picture/prepared_render.h"
#include "runtime/cli/picture/progress.h"
#include "runtime/cli/request/render_request.h"
#include "runtime/render.h"

namespace fathom::cli {

// For --watch: the scene's file with its imports, and whether they have changed since the render began.
struct WatchState {
  runtime::FileWatch files;
  std::atomic<bool> changed = false;
};

ImageFiles image_files_of(const RenderRequest& request);

// Returns nullopt with --watch, which renders from scratch after every change.
std::optional<Checkpoint> checkpoint_of(const RenderRequest& request);

class RenderJob {
 public:
  RenderJob(PreparedRender& picture, const Streams& streams, WatchState* watching,
            std::optional<Interruption>& interruption);

  const runtime::FilmHeader& header() const { return header_; }  // header of its film files

  // To be called once.
  ExitCode run();
  // True if all samples are taken and all files are written.
  bool complete() const { return complete_; }
  const runtime::Stats& stats() const { return stats_; }

 private:
  std::optional<ExitCode> begin();
  runtime::RenderResult render();
  void write_so_far(const runtime::RenderOptions::SnapshotReader& snapshot);
  ExitCode end(runtime::RenderResult& result);
  ExitCode end_undone(const runtime::RenderResult& result);
  ExitCode fail_checkpoint();
  ExitCode fail_to_write(const std::string& problem, const runtime::RenderResult& result, bool kept);
  std::string earlier_state() const;
  void warn_of_invalid(const runtime::Stats& stats);
  void warn_of_image(const runtime::RenderResult& result);
  void warn_of_overflow(const runtime::Stats& stats);
  std::optional<std::string> write_all(runtime::RenderResult& result, bool pictures);
  void print_closing(const runtime::RenderResult& result, const std::vector<std::string>& lines);

  RenderRequest& request_;
  const compiler::CompiledScene& scene_;
  const Streams& streams_;
  WatchState* watching_;
  std::optional<Interruption>& interruption_;
  const runtime::FilmHeader header_;
  std::optional<Checkpoint> checkpoint_;
  ProgressLine line_;
  bool complete_ = false;
  runtime::Stats stats_;
};

}  // namespace fathom::cli
