// fathom render: scene file to pictures. Everything that can be found wrong is found before the first ray.
// Tested by: tests/runtime/cli_test.cpp
#include "runtime/render.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <system_error>

#include "runtime/cli/cost_map.h"
#include "runtime/cli/output_file.h"
#include "runtime/cli/progress.h"
#include "runtime/cli/render_request.h"
#include "runtime/cli/verbosity.h"
#include "runtime/cli/verbs.h"
#include "runtime/image_io.h"

namespace fathom::cli {
namespace {

// The pictures beside the main one: the suffix of the name, whether asked for, how they are made.
struct Layer {
  const char* suffix;
  bool RenderRequest::*wanted;
  runtime::Picture (*picture)(const runtime::Film& film);
};
constexpr Layer kLayers[] = {
    {"albedo", &RenderRequest::albedo, runtime::albedo_picture},
    {"depth", &RenderRequest::depth, runtime::depth_picture},
    {"normal", &RenderRequest::normal, runtime::normal_picture},
};

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
    files.push_back(path);
    for (const Layer& layer : kLayers) {
      if (request.*layer.wanted) files.push_back(beside(path, layer.suffix));
    }
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
std::optional<ExitCode> read_background(const compiler::Background& background, runtime::RenderOptions& options,
                                        const Streams& streams) {
  if (background.type != compiler::Background::Type::Image) return std::nullopt;
  auto image = runtime::read_environment(background.image.file);
  if (const auto* reason = std::get_if<std::string>(&image)) {
    return fail(streams, kIo, fmt::format("cannot read the background `{}`: {}", background.image.file, *reason));
  }
  options.environment =
      std::make_shared<runtime::EnvironmentImage>(std::get<runtime::EnvironmentImage>(std::move(image)));
  return std::nullopt;
}

// Whether every file could be written, as far as can be known before there is anything to write.
std::optional<ExitCode> check_outputs(const RenderRequest& request, const Streams& streams) {
  for (const std::string& path : request.outputs) {
    if (const auto problem = runtime::check_image_path(path)) return fail(streams, kIo, *problem);
    for (const Layer& layer : kLayers) {
      if (!(request.*layer.wanted)) continue;
      if (const auto problem = runtime::check_image_path(beside(path, layer.suffix)))
        return fail(streams, kIo, *problem);
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

runtime::RenderResult render_with_progress(const RenderRequest& request, const compiler::CompiledScene& scene,
                                           const Streams& streams) {
  runtime::RenderOptions options = request.options;
  ProgressLine line(streams);
  if (!request.quiet) options.on_progress = [&](const runtime::Progress& progress) { line.update(progress); };
  return runtime::render(scene, options);
}

std::string written(const std::string& path, const runtime::Film& film) {
  return fmt::format("wrote {} ({}x{})", path, film.width(), film.height());
}

// The pictures for one -o. `lines` collects what was written.
std::optional<std::string> write_pictures(const RenderRequest& request, const std::string& path, double exposure,
                                          const runtime::Film& film, std::vector<std::string>& lines) {
  if (auto problem = runtime::write_image(runtime::beauty_picture(film, exposure), path)) return problem;
  lines.push_back(written(path, film));
  for (const Layer& layer : kLayers) {
    if (!(request.*layer.wanted)) continue;
    const std::string name = beside(path, layer.suffix);
    if (auto problem = runtime::write_image(layer.picture(film), name)) return problem;
    lines.push_back(written(name, film));
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
    if (!problem) problem = write_pictures(request, path, scene.film.exposure, result.film, lines);
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

}  // namespace

int run_render(std::span<const std::string> args, const Streams& streams) {
  auto parsed = parse_render(args, streams);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  RenderRequest& request = std::get<RenderRequest>(parsed);
  if (const auto code = check_collisions(request.scene.path, output_files(request), streams)) return *code;
  if (const auto code = check_outputs(request, streams)) return *code;
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;

  Verbosity verbosity(request.verbosity, streams);
  auto compiled = compile_scene(std::get<compiler::Source>(std::move(source)), request.scene, streams,
                                verbosity.watch_compiler());
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  auto& scene = std::get<compiler::CompiledScene>(compiled);
  if (const auto code = override_scene(request, scene, streams)) return *code;
  if (const auto code = read_background(scene.background, request.options, streams)) return *code;
  verbosity.describe(scene, runtime::resolve(scene, request.options));
  if (request.no_denoise && request.verbosity > 0)
    note(streams, "there is no denoiser; --no-denoise changes nothing");
  if (request.default_output && !request.quiet) {
    note(streams, fmt::format("the picture goes to {}; -o FILE chooses another name", request.outputs.front()));
  }

  runtime::RenderResult result = render_with_progress(request, scene, streams);
  if (const auto code = write_all(request, scene, result, streams)) return *code;
  return kDone;
}

}  // namespace fathom::cli
