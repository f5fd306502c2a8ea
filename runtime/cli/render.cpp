// fathom render: renders a scene file to images. The verb reports every error that can be detected in advance before
// it traces the first ray.
// Tested by: tests/runtime/cli/cli_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <thread>

#include "runtime/cli/frames/render_files.h"
#include "runtime/cli/frames/sequence.h"
#include "runtime/cli/picture/render_job.h"
#include "runtime/cli/plan/unit_run.h"
#include "runtime/cli/request/render_options.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

bool asks_for_checkpoint(std::span<const std::string> args) {
  return std::any_of(args.begin(), args.end(), [](const std::string& arg) {
    return arg.starts_with("--checkpoint") || arg == "--resume" || arg.starts_with("--plan");
  });
}

// Renders one image of the scene file in its current state.
ExitCode render_once(const RenderRequest& request, RenderCache& cache, const Streams& streams, WatchState* watching,
                     std::optional<Interruption>& interruption) {
  const auto input = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&input)) return *code;
  const auto picture = prepare_render(request, std::get<SceneInput>(input), cache, streams);
  if (const auto* code = std::get_if<ExitCode>(&picture)) return *code;
  return RenderJob(*std::get<std::unique_ptr<PreparedRender>>(picture), streams, watching, interruption).run();
}

// Renders again after every change until a signal ends the program. Files are written atomically, so the signal may
// come at any moment.
[[noreturn]] void render_on_change(RenderRequest request, const Streams& streams) {
  WatchState watching{runtime::FileWatch({request.scene.path})};
  request.scene.on_import = [&](const std::string& path) { watching.files.add(path); };
  std::optional<Interruption> none;
  RenderCache cache;
  for (bool first = true;; first = false) {
    watching.changed = false;
    cache.background = nullptr;  // the background's file may have changed
    cache.messages.clear();
    render_once(request, cache, streams, &watching, none);
    if (first && !request.quiet) {
      note(streams, fmt::format("drawing again whenever {} changes; Ctrl-C ends", request.scene.path));
    }
    streams.err.flush();
    streams.out.flush();
    do std::this_thread::sleep_for(runtime::kWatchInterval);
    while (!watching.files.settled());
  }
}

}  // namespace

int run_render(std::span<const std::string> args, const Streams& streams) {
  // The Interruption exists from the start, so that a signal ends the command in time even while the scene is read
  // and compiled.
  std::optional<Interruption> interruption;
  if (asks_for_checkpoint(args)) interruption.emplace().begin_preparation();
  auto parsed = parse_render(args, streams);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const RenderRequest& request = std::get<RenderRequest>(parsed);
  if (request.units.given()) return render_units(request, streams, interruption);
  if (const auto code = check_bits(image_files_of(request), streams)) return *code;
  if (request.frames.given()) return render_frames(request, streams, interruption);
  if (const auto code = claim_outputs(output_files(request), streams)) return *code;
  if (const auto code = check_outputs(request, streams)) return *code;
  if (request.watch) {
    interruption.reset();
    render_on_change(request, streams);
  }
  RenderCache cache;
  return render_once(request, cache, streams, nullptr, interruption);
}

}  // namespace fathom::cli
