// fathom render: scene file to pictures. Everything that can be found wrong is found before the first ray.
// Tested by: tests/runtime/cli_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <ostream>
#include <thread>
#include <utility>

#include "runtime/cli/cost_map.h"
#include "runtime/cli/memory.h"
#include "runtime/cli/picture_job.h"
#include "runtime/cli/verbosity.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

// Every file the run will write, but for streams.
std::vector<std::string> output_files(const RenderRequest& request) {
  std::vector<std::string> files = files_of(pictures_of(request));
  if (request.cost_map) {
    for (const std::string& map : cost_map_files(*request.cost_map)) files.push_back(map);
  }
  if (request.stats_json && *request.stats_json != "-" && !is_special(*request.stats_json)) {
    files.push_back(*request.stats_json);
  }
  if (const auto checkpoint = checkpoint_of(request)) files.push_back(checkpoint->path());
  return files;
}

// The picture that the scene's background names.
std::optional<ExitCode> read_background(const compiler::Background& background, const SceneArguments& arguments,
                                        runtime::RenderOptions& options, const Streams& streams) {
  if (background.type != compiler::Background::Type::Image) return std::nullopt;
  auto image = runtime::read_environment(background.image.file, read_limits(arguments.limits));
  if (const auto* unread = std::get_if<runtime::UnreadImage>(&image)) {
    return fail_about(arguments, unread->missing ? kIo : kBadScene, "the scene's background: " + unread->problem, {},
                      streams);
  }
  options.environment =
      std::make_shared<runtime::EnvironmentImage>(std::get<runtime::EnvironmentImage>(std::move(image)));
  return std::nullopt;
}

// Whether every file could be written, as far as can be known before there is anything to write.
std::optional<ExitCode> check_outputs(const RenderRequest& request, const Streams& streams) {
  if (const auto code = check_paths(pictures_of(request), streams)) return code;
  if (const auto checkpoint = checkpoint_of(request)) {
    if (const auto code = checkpoint->check_path(streams)) return code;
  }
  if (request.cost_map) {
    for (const std::string& map : cost_map_files(*request.cost_map)) {
      if (const auto problem = runtime::check_file_path(map)) return fail(streams, kIo, *problem);
    }
  }
  if (request.stats_json) {
    const bool stream = *request.stats_json == "-";
    if (const auto problem = stream ? std::nullopt : check_text_path(*request.stats_json))
      return fail(streams, kIo, *problem);
  }
  return std::nullopt;
}

bool asks_for_checkpoint(std::span<const std::string> args) {
  return std::any_of(args.begin(), args.end(),
                     [](const std::string& arg) { return arg.starts_with("--checkpoint") || arg == "--resume"; });
}

// One picture of the file as it is now.
ExitCode render_once(const RenderRequest& asked, const Streams& streams, Watching* watching,
                     std::optional<Interruption>& interruption) {
  RenderRequest request = asked;
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  Verbosity verbosity(request.verbosity, streams);
  compiler::CompileOptions options = verbosity.watch_compiler();
  options.lint_picture = true;
  options.stage = true;
  auto compiled = compile_scene(std::get<SceneInput>(std::move(source)), request.scene, streams, options);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  auto& scene = std::get<compiler::CompiledScene>(compiled);
  if (const auto code = override_scene(request, scene, streams)) return *code;
  if (const auto code = check_memory(request, scene, streams)) return *code;
  fit_regions(request, scene);
  if (const auto code = read_background(scene.background, request.scene, request.options, streams)) return *code;
  verbosity.describe(scene, runtime::resolve(scene, request.options));
  const bool first = !watching || !std::exchange(watching->begun, true);
  if (request.default_output && first && !request.quiet) {
    note(streams, fmt::format("the picture goes to {}; -o FILE chooses another name", request.outputs.front().path));
  }
  if (request.options.clamp && first && !request.quiet) {
    note(streams, "--clamp: light is lost, and the picture darker than it should be where light is clamped");
  }
  return PictureJob(request, scene, streams, watching, interruption).run();
}

// Until a signal ends the program: files are written whole or not at all, so any moment will do.
[[noreturn]] void render_on_change(const RenderRequest& request, const Streams& streams) {
  Watching watching{runtime::FileWatch({request.scene.path})};
  std::optional<Interruption> none;
  for (bool first = true;; first = false) {
    watching.changed = false;
    render_once(request, streams, &watching, none);
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
  std::signal(SIGUSR1, SIG_IGN);  // who asks for a picture when there is none gets none
  // Whoever asks for a checkpoint gets one from the first moment on, while the scene is read and compiled, too.
  std::optional<Interruption> interruption;
  if (asks_for_checkpoint(args)) interruption.emplace();
  std::signal(SIGPIPE, SIG_IGN);  // who reads the messages may go before the render is done
  auto parsed = parse_render(args, streams);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const RenderRequest& request = std::get<RenderRequest>(parsed);
  if (const auto code = check_bits(pictures_of(request), streams)) return *code;
  if (const auto code = check_collisions(request.scene.path, output_files(request), streams)) return *code;
  if (const auto code = check_outputs(request, streams)) return *code;
  if (request.watch) {
    interruption.reset();
    render_on_change(request, streams);
  }
  return render_once(request, streams, nullptr, interruption);
}

}  // namespace fathom::cli
