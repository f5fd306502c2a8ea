#include "runtime/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fathom/fathom.hpp>
#include <list>

#include "bindings/cpp/guard.h"
#include "bindings/cpp/image_data.h"
#include "bindings/cpp/scene_data.h"
#include "compiler/scene/framing.h"
#include "runtime/base/machine.h"
#include "runtime/denoise/denoise.h"
#include "runtime/light/environment_map.h"
#include "runtime/sampling/shutter.h"

namespace fathom {
namespace {

// A scene prepared to be rendered.
struct Picture {
  compiler::CompiledScene scene;
  std::list<compiler::CompiledScene> moments;  // during the open shutter; `options` points to them
  runtime::RenderOptions options;
};

Error set_size(const RenderOptions& options, compiler::Film& film) {
  const double aspect = static_cast<double>(film.width) / film.height;
  double width = options.width.value_or(film.width), height = options.height.value_or(film.height);
  if (!options.width && options.height) width = std::max(1.0, std::round(height * aspect));
  if (options.width && !options.height) height = std::max(1.0, std::round(width / aspect));
  if (!(width >= 1 && height >= 1 && width <= compiler::kMaxSide && height <= compiler::kMaxSide)) {
    return library::bad_argument(fmt::format("the size {}x{} is not from 1x1 to {}x{} pixels", width, height,
                                             compiler::kMaxSide, compiler::kMaxSide));
  }
  film.width = static_cast<int>(width);
  film.height = static_cast<int>(height);
  return {};
}

Error set_samples(const RenderOptions& options, compiler::RenderSettings& settings) {
  if (options.samples) {
    if (*options.samples < 1 || *options.samples > compiler::kMaxSpp) {
      return library::bad_argument(
          fmt::format("{} samples are not from 1 to {}", *options.samples, compiler::kMaxSpp));
    }
    settings.spp = *options.samples;
  }
  if (options.denoise && settings.spp < 2) {
    return library::bad_argument("a single sample per pixel cannot be denoised: its noise shows between samples");
  }
  if (options.seed) settings.seed = *options.seed;
  return {};
}

Error read_background(Picture& picture, double memory) {
  const compiler::Background& background = picture.scene.background;
  if (background.type != compiler::Background::Type::Image) return {};
  auto read = runtime::read_background(background.image.file, {memory});
  if (const auto* unread = std::get_if<runtime::ImageReadError>(&read)) {
    return {unread->missing ? Error::Kind::File : Error::Kind::BadScene, unread->problem};
  }
  picture.options.environment = std::get<std::shared_ptr<const runtime::EnvironmentMap>>(std::move(read));
  return {};
}

// Compiles the scene at the moments of the open shutter, if there is motion.
Error open_shutter(Picture& picture, const Scene::Data& data, double aspect) {
  const compiler::CompiledScene& scene = picture.scene;
  const auto time = std::ranges::find(scene.parameters, compiler::kTimeParameter, &compiler::Parameter::name);
  if (scene.camera.shutter <= 0 || time == scene.parameters.end() || !data.has_text) return {};
  if (scene.settings.noise_threshold) {
    return {Error::Kind::BadScene, "a noise threshold does not go with a camera's `shutter`"};
  }
  const double open = scene.camera.shutter / scene.film.fps;
  for (const runtime::ShutterInterval& run :
       runtime::shutter_intervals(scene.settings.spp, runtime::kDefaultShutterTimes, scene.settings.seed, 0)) {
    std::string message;
    const double moment = time->value + open * run.time;
    auto compiled =
        library::compile_picture(data, {{std::string(compiler::kTimeParameter), moment}}, scene.origin, message);
    if (!compiled) return {Error::Kind::BadScene, std::move(message)};
    compiled->film = scene.film;
    compiled->camera = compiler::placed(compiled->camera, compiled->extent, aspect);
    picture.moments.push_back(std::move(*compiled));
    picture.options.moments.push_back({&picture.moments.back(), run.samples});
  }
  return {};
}

Error check_memory(const Picture& picture, double allowed, bool denoise) {
  const runtime::Settings settings = runtime::resolve(picture.scene, picture.options);
  const auto film =
      static_cast<double>(runtime::Film::memory_per_pixel(settings.layers, runtime::stages_of(settings)));
  const double needed =
      static_cast<double>(settings.crop.pixels()) * (film + (denoise ? runtime::kDenoiserBytes : 0));
  if (needed <= allowed) return {};
  return {Error::Kind::OutOfMemory,
          fmt::format("the render would take {:.0f} bytes of memory; {:.0f} are allowed", needed, allowed)};
}

Error prepare(const Scene::Data& data, const RenderOptions& options, Picture& picture) {
  if (data.foreign && data.has_text) {
    std::string message;
    auto staged = library::compile_picture(data, {}, std::nullopt, message);
    if (!staged) return {Error::Kind::BadScene, std::move(message)};
    picture.scene = std::move(*staged);
  }
  compiler::CompiledScene& scene = picture.scene;
  if (Error error = set_size(options, scene.film)) return error;
  if (Error error = set_samples(options, scene.settings)) return error;
  if (options.threads < 0) return library::bad_argument("the number of threads is below 0");
  const double aspect = static_cast<double>(scene.film.width) / scene.film.height;
  scene.camera = compiler::placed(scene.camera, scene.extent, aspect);
  picture.options.threads = options.threads;
  picture.options.time_limit = options.time_limit;
  picture.options.layers = {.first_hit = true, .position = true, .ids = true, .halves = options.denoise};
  if (Error error = check_memory(picture, data.limits.memory, options.denoise)) return error;
  if (Error error = read_background(picture, data.limits.memory)) return error;
  return open_shutter(picture, data, aspect);
}

// Renders the picture until it is done or a stop is requested.
Image render_image(const RenderOptions& options, Picture& picture) {
  std::atomic<bool> cancel = false;
  const std::stop_callback on_stop(options.stop, [&] { cancel = true; });
  picture.options.cancel = &cancel;
  if (options.progress) {
    picture.options.on_progress = [&](const runtime::Progress& progress) { options.progress(progress.fraction); };
  }
  runtime::RenderResult result = runtime::render(picture.scene, picture.options);
  auto data = std::make_shared<Image::Data>();
  using End = runtime::RenderEnd;
  data->complete = result.stats.end == End::Done || result.stats.end == End::Noise;
  const int threads = options.threads > 0 ? options.threads : runtime::usable_processors();
  if (options.denoise && !runtime::denoise(result.film, threads, [&] { return cancel.load(); })) {
    data->complete = false;
  }
  data->film = std::move(result.film);
  data->tone = {picture.scene.film.exposure, picture.scene.film.tone};
  data->origin = picture.scene.origin;
  for (const compiler::Surface& surface : picture.scene.surfaces) data->objects.push_back(surface.name);
  return Image(std::move(data));
}

}  // namespace

Rendered Scene::render(const RenderOptions& options) const noexcept {
  Rendered out;
  out.error = library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(library::kNoScene);
    Picture picture{data_->scene, {}, {}};
    if (Error error = prepare(*data_, options, picture)) return error;
    out.image = render_image(options, picture);
    return {};
  });
  return out;
}

}  // namespace fathom
