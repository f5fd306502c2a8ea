// fathom render: scene file to pictures. Everything that can be found wrong is found before the first ray.
// Tested by: tests/runtime/cli_test.cpp
#include "runtime/render.h"

#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <system_error>
#include <thread>

#include "runtime/cli/cost_map.h"
#include "runtime/cli/memory.h"
#include "runtime/cli/output_file.h"
#include "runtime/cli/picture_attributes.h"
#include "runtime/cli/progress.h"
#include "runtime/cli/render_request.h"
#include "runtime/cli/verbosity.h"
#include "runtime/cli/verbs.h"
#include "runtime/denoise.h"
#include "runtime/file_watch.h"
#include "runtime/film_channels.h"
#include "runtime/image_exr.h"
#include "runtime/image_io.h"

namespace fathom::cli {
namespace {

// The layers that an output is of, and the file of each.
struct LayerFile {
  runtime::Layer layer;
  std::string path;
};
std::vector<LayerFile> layer_files(const RenderRequest& request, const std::string& output) {
  std::vector<LayerFile> files = {{runtime::Layer::Beauty, output}};
  if (holds_layers(output)) return files;
  const auto add = [&](bool wanted, runtime::Layer layer) {
    if (wanted) files.push_back({layer, beside(output, std::string(runtime::info(layer).name))});
  };
  add(request.albedo, runtime::Layer::Albedo);
  add(request.depth, runtime::Layer::Depth);
  add(request.normal, runtime::Layer::Normal);
  add(request.denoise, runtime::Layer::Noisy);
  return files;
}

// Devices and pipes are written to as they are; only files appear whole or not at all.
bool is_special(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

std::optional<std::string> check_stats_path(const std::string& path) {
  std::error_code ignored;
  if (path == "-" || (is_special(path) && !std::filesystem::is_directory(path, ignored))) return std::nullopt;
  return runtime::check_file_path(path);
}

// Every file the run will write, but for streams.
std::vector<std::string> output_files(const RenderRequest& request) {
  std::vector<std::string> files;
  for (const std::string& path : request.outputs) {
    for (const LayerFile& file : layer_files(request, path)) files.push_back(file.path);
  }
  if (request.cost_map) {
    for (const std::string& map : cost_map_files(*request.cost_map)) files.push_back(map);
  }
  if (request.stats_json && *request.stats_json != "-" && !is_special(*request.stats_json)) {
    files.push_back(*request.stats_json);
  }
  return files;
}

// The picture that the scene's background names.
std::optional<ExitCode> read_background(const compiler::Background& background, const compiler::Limits& limits,
                                        runtime::RenderOptions& options, const Streams& streams) {
  if (background.type != compiler::Background::Type::Image) return std::nullopt;
  auto image = runtime::read_environment(background.image.file, read_limits(limits));
  if (const auto* unread = std::get_if<runtime::UnreadImage>(&image)) {
    return fail(streams, unread->missing ? kIo : kBadScene, "the scene's background: " + unread->problem);
  }
  options.environment =
      std::make_shared<runtime::EnvironmentImage>(std::get<runtime::EnvironmentImage>(std::move(image)));
  return std::nullopt;
}

// Whether every file could be written, as far as can be known before there is anything to write.
std::optional<ExitCode> check_outputs(const RenderRequest& request, const Streams& streams) {
  for (const std::string& path : request.outputs) {
    for (const LayerFile& file : layer_files(request, path)) {
      if (const auto problem = runtime::check_image_path(file.path)) return fail(streams, kIo, *problem);
    }
  }
  if (request.cost_map) {
    for (const std::string& map : cost_map_files(*request.cost_map)) {
      if (const auto problem = runtime::check_file_path(map)) return fail(streams, kIo, *problem);
    }
  }
  if (request.stats_json) {
    if (const auto problem = check_stats_path(*request.stats_json)) return fail(streams, kIo, *problem);
  }
  return std::nullopt;
}

// For --watch: the scene's file, and whether the render under way is no longer of it.
struct Watching {
  runtime::FileWatch files;
  std::atomic<bool> changed = false;
};

// `watching`, when given, ends the render as soon as there is a new file.
runtime::RenderResult render_with_progress(const RenderRequest& request, const compiler::CompiledScene& scene,
                                           const Streams& streams, Watching* watching) {
  runtime::RenderOptions options = request.options;
  if (watching) options.cancel = &watching->changed;
  ProgressLine line(streams);
  options.on_progress = [&](const runtime::Progress& progress) {
    if (!request.quiet) line.update(progress);
    if (watching && watching->files.changed()) watching->changed = true;
  };
  return runtime::render(scene, options);
}

std::string written(const std::string& path, const runtime::Film& film) {
  return fmt::format("wrote {} ({}x{})", path, film.width(), film.height());
}

// One -o, in all its files. `lines` collects what was written.
std::optional<std::string> write_output(const RenderRequest& request, const std::string& path,
                                        const compiler::CompiledScene& scene, const runtime::RenderResult& result,
                                        std::vector<std::string>& lines) {
  const runtime::Film& film = result.film;
  const runtime::Settings& settings = result.settings;
  if (holds_layers(path)) {
    std::optional<double> seconds;
    if (request.options.profile) seconds = result.stats.seconds;
    const auto rows = runtime::rows_of(film, settings.width, settings.height, scene.origin,
                                       picture_attributes(scene, settings, seconds));
    if (auto problem = runtime::write_exr(rows, path)) return problem;
    lines.push_back(written(path, film) + fmt::format(": {} channels", rows.channels.size()));
    return std::nullopt;
  }
  const runtime::PictureOptions options{{scene.film.exposure, scene.film.tone}, request.bits == 0 ? 8 : 16};
  for (const LayerFile& file : layer_files(request, path)) {
    if (auto problem = runtime::write_layer(runtime::layer_of(film, file.layer), options, file.path)) return problem;
    lines.push_back(written(file.path, film));
  }
  return std::nullopt;
}

std::optional<std::string> write_stats(const std::string& path, const runtime::Stats& stats, const Streams& streams) {
  const std::string text = runtime::to_json(stats);
  if (path == "-") {
    streams.out << text;
    return std::nullopt;
  }
  if (!is_special(path)) return runtime::write_file({text.begin(), text.end()}, path);
  std::ofstream file(path);
  file << text << std::flush;
  return file ? std::nullopt : std::optional(fmt::format("cannot write `{}`", path));
}

// Writes everything and prints the closing numbers, whose memory is that of writing, too.
std::optional<ExitCode> write_all(const RenderRequest& request, const compiler::CompiledScene& scene,
                                  runtime::RenderResult& result, const Streams& streams) {
  std::vector<std::string> lines;
  std::optional<std::string> problem;
  for (const std::string& path : request.outputs) {
    if (!problem) problem = write_output(request, path, scene, result, lines);
  }
  if (request.cost_map && !problem) problem = write_cost_maps(*request.cost_map, result.film, lines);
  result.stats.peak_memory = runtime::peak_memory();
  if (request.stats_json && !problem) problem = write_stats(*request.stats_json, result.stats, streams);
  if (!request.quiet) {
    streams.err << runtime::to_table(result.stats);
    for (const std::string& line : lines) streams.err << line << '\n';
  }
  if (problem) return fail(streams, kIo, *problem);
  return std::nullopt;
}

// One picture of the file as it is now.
ExitCode render_once(const RenderRequest& asked, const Streams& streams, Watching* watching) {
  RenderRequest request = asked;
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  Verbosity verbosity(request.verbosity, streams);
  auto compiled =
      compile_scene(std::get<SceneInput>(std::move(source)), request.scene, streams, verbosity.watch_compiler());
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  auto& scene = std::get<compiler::CompiledScene>(compiled);
  if (const auto code = override_scene(request, scene, streams)) return *code;
  if (const auto code = check_memory(request, scene, streams)) return *code;
  if (const auto code = read_background(scene.background, request.scene.limits, request.options, streams))
    return *code;
  verbosity.describe(scene, runtime::resolve(scene, request.options));
  if (request.default_output && !request.quiet) {
    note(streams, fmt::format("the picture goes to {}; -o FILE chooses another name", request.outputs.front()));
  }
  if (request.options.clamp && !request.quiet) {
    note(streams, "--clamp: light is lost, and the picture darker than it should be where light is clamped");
  }

  runtime::RenderResult result = render_with_progress(request, scene, streams, watching);
  if (result.stats.cancelled) return kDone;
  if (result.stats.saturated > 0) {
    streams.err << fmt::format(
        "warning: {} lost: a pixel's samples add up to {:.2g} at most; scale the lights down\n",
        count_of(result.stats.saturated, "sample"), runtime::kFullPixel);
  }
  if (request.denoise) runtime::denoise(result.film, result.settings.threads);
  if (const auto code = write_all(request, scene, result, streams)) return *code;
  return kDone;
}

// Until a signal ends the program: files are written whole or not at all, so any moment will do.
[[noreturn]] void render_on_change(const RenderRequest& request, const Streams& streams) {
  Watching watching{runtime::FileWatch({request.scene.path})};
  while (true) {
    watching.changed = false;
    render_once(request, streams, &watching);
    if (!watching.changed && !request.quiet) {
      note(streams, fmt::format("waiting for {} to change; Ctrl-C ends", request.scene.path));
    }
    streams.err.flush();
    streams.out.flush();
    do std::this_thread::sleep_for(runtime::kWatchInterval);
    while (!watching.files.settled());
  }
}

}  // namespace

int run_render(std::span<const std::string> args, const Streams& streams) {
  auto parsed = parse_render(args, streams);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const RenderRequest& request = std::get<RenderRequest>(parsed);
  if (const auto code = check_collisions(request.scene.path, output_files(request), streams)) return *code;
  if (const auto code = check_outputs(request, streams)) return *code;
  if (request.watch) render_on_change(request, streams);
  return render_once(request, streams, nullptr);
}

}  // namespace fathom::cli
