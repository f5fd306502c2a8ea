#include "runtime/cli/picture/prepared_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/cli/input/memory.h"
#include "runtime/cli/input/verbosity.h"
#include "runtime/cli/options/buffered_messages.h"
#include "runtime/cli/request/render_memory.h"
#include "runtime/render.h"
#include "runtime/sampling/shutter.h"

namespace fathom::cli {
namespace {

using MaybeScene = std::variant<compiler::CompiledScene, ExitCode>;

// Reads the environment map that the scene's background names.
std::optional<ExitCode> find_background(const compiler::Background& background, const SceneArguments& arguments,
                                        RenderCache& cache, runtime::RenderOptions& options, const Streams& streams) {
  if (background.type != compiler::Background::Type::Image) return std::nullopt;
  const std::string& file = background.image.file;
  if (!cache.background || cache.background_file != file) {
    if (const auto code = cache_background(file, file, arguments, cache, streams)) return code;
  }
  options.environment = cache.background;
  return std::nullopt;
}

const compiler::Parameter* find_time(const compiler::CompiledScene& scene) {
  const auto found = std::find_if(scene.parameters.begin(), scene.parameters.end(),
                                  [](const auto& parameter) { return parameter.name == compiler::kTimeParameter; });
  return found == scene.parameters.end() ? nullptr : &*found;
}

// Checks the options that only apply to motion.
std::optional<ExitCode> check_motion(const RenderRequest& request, const compiler::CompiledScene& scene, bool blurs,
                                     const Streams& streams) {
  if (!blurs && request.frames.shutter_times) {
    return fail(streams, kUsage, "--shutter-times: nothing is blurred without a camera's `shutter` and a `time`",
                {"give the scene's camera a `shutter`, as 0.5, and the scene a parameter `time`"});
  }
  if (!blurs && request.frames.fps && !request.frame) {
    return fail(streams, kUsage, "--fps is for --frames, or for a camera with a `shutter`", {"add --frames A:B"});
  }
  if (!blurs) return std::nullopt;
  if (!runtime::resolve(scene, request.options).noise_threshold) return std::nullopt;
  return fail(
      streams, kUsage,
      "a noise threshold does not go with a `shutter`: a pixel's samples are of moments one after the other, so "
      "that fewer would leave out the last",
      {request.options.noise_threshold ? "leave out --noise-threshold, or the camera's `shutter`" : "add --uniform"});
}

// Compiles the picture's scene at another time.
MaybeScene compile_moment(const PreparedRender& picture, const SceneInput& input, double time,
                          const Streams& streams) {
  SceneArguments arguments = picture.request.scene;
  arguments.definitions.emplace_back(compiler::kTimeParameter, time);
  compiler::CompileOptions options;
  options.stage = true;
  options.pieces = true;
  options.origin = picture.scene.origin;
  options.file_at_hand = picture.scene.background.image.file;
  BufferedMessages held(streams);
  MaybeScene compiled = compile_scene(input, arguments, held.streams(), options);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) {
    held.release();
    return fail(streams, *code, fmt::format("the scene has errors at {:.6g} s, while the shutter is open", time));
  }
  auto& scene = std::get<compiler::CompiledScene>(compiled);
  scene.film = picture.scene.film;
  if (const auto code = override_camera(picture.request, scene, streams)) return *code;
  return compiled;
}

// Compiles the scene at the moments of the open shutter. `seed` is the seed shared by all frames.
std::optional<ExitCode> open_shutter(PreparedRender& picture, const SceneInput& input, double time,
                                     std::uint64_t seed, const Streams& streams) {
  RenderRequest& request = picture.request;
  const double open = picture.scene.camera.shutter / request.frames.fps.value_or(picture.scene.film.fps);
  const int frame = request.frame && !request.frames.fixed_noise ? request.frame->number : 0;
  const int times = request.frames.shutter_times.value_or(runtime::kDefaultShutterTimes);
  const auto runs = runtime::shutter_intervals(picture.scene.settings.spp, times, seed, frame);
  picture.moments.reserve(runs.size());  // options.moments points to the elements
  for (const runtime::ShutterInterval& run : runs) {
    MaybeScene scene = compile_moment(picture, input, time + open * run.time, streams);
    if (const auto* code = std::get_if<ExitCode>(&scene)) return *code;
    picture.moments.push_back(std::get<compiler::CompiledScene>(std::move(scene)));
    request.options.moments.push_back({&picture.moments.back(), run.samples});
  }
  return std::nullopt;
}

void say_what_is_always_so(const RenderRequest& request, const Streams& streams) {
  if (request.quiet) return;
  if (request.default_output) {
    note(streams, fmt::format("the picture goes to {}; -o FILE chooses another name", request.outputs.front().path));
  }
  if (request.options.clamp || request.options.sample_clamp) {
    note(streams, fmt::format("{}: light is lost, and the picture darker than it should be where light is clamped",
                              request.options.clamp ? "--clamp" : "--sample-clamp"));
  }
}

// Applies the command line's settings to the scene, and prepares everything else that the picture needs.
std::optional<ExitCode> complete(PreparedRender& picture, const SceneInput& input, RenderCache& cache,
                                 const Streams& streams) {
  RenderRequest& request = picture.request;
  compiler::CompiledScene& scene = picture.scene;
  if (const auto code = override_scene(request, scene, streams)) return code;
  if (const auto code = check_memory(request, scene, streams)) return code;
  fit_regions(request, scene);
  if (const auto code = find_background(scene.background, request.scene, cache, request.options, streams))
    return code;
  request.options.region_store = cache.regions;
  const std::uint64_t seed = scene.settings.seed;
  if (request.frame && !request.frames.fixed_noise) {
    request.options.seed = runtime::frame_seed(seed, request.frame->number);
  }
  const compiler::Parameter* time = find_time(scene);
  const bool blurs = scene.camera.shutter > 0 && time != nullptr;
  if (const auto code = check_motion(request, scene, blurs, streams)) return code;
  return blurs ? open_shutter(picture, input, time->value, seed, streams) : std::nullopt;
}

}  // namespace

std::optional<ExitCode> cache_background(const std::string& file, const std::string& name,
                                         const SceneArguments& arguments, RenderCache& cache,
                                         const Streams& streams) {
  auto read = runtime::read_background(file, read_limits(arguments.limits));
  if (const auto* unread = std::get_if<runtime::ImageReadError>(&read)) {
    return fail_about(arguments, unread->missing ? kIo : kBadScene, unread->problem, {}, streams);
  }
  cache.background_file = name;
  cache.background = std::get<std::shared_ptr<const runtime::EnvironmentMap>>(std::move(read));
  if (!cache.background->warning.empty()) warn(streams, cache.background->warning);
  return std::nullopt;
}

std::variant<std::unique_ptr<PreparedRender>, ExitCode> prepare_render(const RenderRequest& request,
                                                                       const SceneInput& input, RenderCache& cache,
                                                                       const Streams& streams) {
  Verbosity verbosity(request.verbosity, streams);
  compiler::CompileOptions options = verbosity.watch_compiler();
  options.lint_picture = true;
  options.stage = true;
  options.pieces = true;
  if (cache.background) options.file_at_hand = cache.background_file;
  BufferedMessages held(streams);
  MaybeScene compiled = compile_scene(input, request.scene, held.streams(), options);
  held.release_if_new(cache.messages);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  auto picture = std::make_unique<PreparedRender>(
      PreparedRender{request, std::get<compiler::CompiledScene>(std::move(compiled)), {}});
  if (const auto code = complete(*picture, input, cache, streams)) return *code;
  verbosity.describe(picture->scene, runtime::resolve(picture->scene, picture->request.options));
  if (!std::exchange(cache.begun, true)) say_what_is_always_so(request, streams);
  return picture;
}

}  // namespace fathom::cli
