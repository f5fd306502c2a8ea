#include "runtime/cli/request/render_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/film/adaptive.h"

namespace fathom::cli {
namespace {

// --preview divides each side by this.
constexpr int kPreviewShrink = 4;
constexpr int kPreviewSpp = 4;

// Returns the requested marching. Prints a message and returns an exit code if options conflict.
std::variant<runtime::Marching, ExitCode> marching_of(const RenderRequest& request, const Streams& streams) {
  runtime::Marching marching;
  if (request.method >= 0) marching.method = runtime::kMethods[request.method].method;
  const runtime::MethodInfo& method = runtime::info(marching.method);
  if ((request.epsilon || request.steps) && !method.uses_epsilon) {
    return fail(streams, kUsage, fmt::format("--epsilon and --max-steps: the method `{}` has neither", method.name),
                {"they go with --march sphere, relaxed or automatic"});
  }
  if (request.relaxation && marching.method != runtime::Method::Relaxed) {
    return fail(streams, kUsage, "--relaxation goes with --march relaxed only");
  }
  if (request.precision >= 0) {
    if (marching.method == runtime::Method::Certified) {
      return fail(streams, kUsage, "--precision does not go with --march certified, which is always in double");
    }
    marching.precision = static_cast<runtime::Precision>(request.precision);
  }
  marching.epsilon = request.epsilon.value_or(marching.epsilon);
  marching.steps = request.steps.value_or(marching.steps);
  marching.relaxation = request.relaxation.value_or(marching.relaxation);
  return marching;
}

int pixel_of(const CropSides::Side& side, int length) {
  return static_cast<int>(std::min(side.percent ? std::round(side.value * length / 100) : side.value, 1e9));
}

// Returns the crop's pixels. Prints a message and returns an exit code if the crop is empty or reaches beyond the
// image.
std::variant<runtime::PixelRect, ExitCode> crop_of(const CropSides& crop, int width, int height,
                                                   const Streams& streams) {
  const runtime::PixelRect area{pixel_of(crop.x0, width), pixel_of(crop.y0, height), pixel_of(crop.x1, width),
                                pixel_of(crop.y1, height)};
  const std::string pixels = fmt::format("{},{},{},{}", area.x0, area.y0, area.x1, area.y1);
  if (area.width() < 1 || area.height() < 1) {
    return fail(streams, kUsage, fmt::format("--crop: there are no pixels in {}", pixels),
                {"give the corner with the smaller coordinates first; the second is not part of it"});
  }
  if (area.x1 > width || area.y1 > height) {
    return fail(streams, kUsage, fmt::format("--crop: {} reaches beyond the picture", pixels),
                {fmt::format("the whole picture is 0,0,{},{}", width, height)});
  }
  return area;
}

// Prints a message and returns an exit code if options conflict with a noise threshold. Too few samples only disable
// a threshold that the scene sets.
std::optional<ExitCode> check_noise_threshold(const RenderRequest& request, const compiler::CompiledScene& scene,
                                              const Streams& streams) {
  const bool asked = request.options.noise_threshold.has_value();
  const int spp = scene.settings.spp;
  if (asked && spp < runtime::kMinAdaptiveSpp) {
    return fail(streams, kUsage,
                fmt::format("--noise-threshold: {} per pixel are too few to share out",
                            count_of(static_cast<std::size_t>(spp), "sample")),
                {fmt::format("ask for --spp {} or more", runtime::kMinAdaptiveSpp)});
  }
  const std::string_view part = request.crop ? "--crop" : request.options.sample_range ? "--sample-range" : "";
  if (part.empty() || !runtime::resolve(scene, request.options).noise_threshold) return std::nullopt;
  return fail(streams, kUsage,
              fmt::format("{} does not go with {}: a pixel's samples depend on the whole picture", part,
                          asked ? "--noise-threshold" : "the scene's `noise_threshold`"),
              {asked ? "leave out --noise-threshold, or render the whole" : "add --uniform, or render the whole"});
}

std::optional<ExitCode> check_sample_range(const RenderRequest& request, const compiler::CompiledScene& scene,
                                           const Streams& streams) {
  const std::optional<runtime::SampleRange>& range = request.options.sample_range;
  if (!range || range->last <= static_cast<std::uint32_t>(scene.settings.spp)) return std::nullopt;
  return fail(streams, kUsage,
              fmt::format("--sample-range: {} is beyond the {} of a pixel", range->last,
                          count_of(static_cast<std::size_t>(scene.settings.spp), "sample")),
              {"--spp says how many there are in all parts together"});
}

std::optional<ExitCode> check_watch(const RenderRequest& request, const Streams& streams) {
  if (!request.watch) return std::nullopt;
  if (request.scene.path == "-") {
    return fail(streams, kUsage, "--watch: standard input cannot change", {"name the scene's file"});
  }
  if (request.checkpoint || request.checkpoint_interval || request.resume) {
    return fail(streams, kUsage, "--watch begins again with every change: it goes with no checkpoint",
                {"leave out --checkpoint, --checkpoint-interval and --resume"});
  }
  return std::nullopt;
}

// Prints a message and returns an exit code if options conflict, whatever the scene.
std::optional<ExitCode> check_together(const RenderRequest& request, const Streams& streams) {
  if (request.size && (request.resolution || request.aspect)) {
    return fail(streams, kUsage, "--size gives width and height; it does not go with --resolution or --aspect");
  }
  if (request.quiet && request.verbosity > 0) return fail(streams, kUsage, "--quiet does not go with --verbose");
  if (request.quiet && request.options.profile && !request.stats_json) {
    return fail(streams, kUsage, "--quiet leaves out the numbers that --profile adds to",
                {"leave out --quiet, or ask for --stats-json FILE"});
  }
  if (const auto code = check_watch(request, streams)) return code;
  if (request.denoise && request.no_denoise) return fail(streams, kUsage, "--denoise does not go with --no-denoise");
  if (request.options.noise_threshold && request.options.uniform) {
    return fail(streams, kUsage, "--noise-threshold does not go with --uniform");
  }
  return std::nullopt;
}

// Translates the flags to options of the renderer.
void put_flags(RenderRequest& request) {
  runtime::RenderOptions& options = request.options;
  if (request.preview) {
    request.denoise = !request.no_denoise;
    if (!options.spp) options.spp = kPreviewSpp;
  }
  options.layers = {.first_hit = request.albedo || request.depth || request.normal,
                    .cost = request.cost_map.has_value()};
  if (std::any_of(request.outputs.begin(), request.outputs.end(), [](const Output& o) { return o.layers(); })) {
    options.layers = runtime::kAllLayers;
  }
  if (request.denoise) options.layers.first_hit = options.layers.halves = true;
  options.regions = !request.no_regions;
  options.native_code = !request.no_native;
  if (request.region_memory) options.region_memory = static_cast<std::size_t>(*request.region_memory) << 20;
}

std::optional<ExitCode> override_fov(const RenderRequest& request, compiler::Camera& camera, const Streams& streams) {
  if (!request.fov) return std::nullopt;
  if (camera.projection == compiler::Camera::Projection::Orthographic) {
    return fail(streams, kUsage, "--fov: the scene's camera is orthographic and has no field of view",
                {"its `width` in the scene file says how much it sees"});
  }
  if (camera.projection == compiler::Camera::Projection::Panorama) {
    return fail(streams, kUsage, "--fov: the scene's camera is a panorama, which shows all directions");
  }
  camera.fov = *request.fov;
  camera.vertical_fov.reset();
  camera.focal_length.reset();
  return std::nullopt;
}

std::optional<ExitCode> override_size(const RenderRequest& request, compiler::Film& film, const Streams& streams) {
  double width = request.resolution.value_or(film.width), height = film.height;
  if (request.aspect || request.resolution) {
    const double aspect = request.aspect.value_or(static_cast<double>(film.width) / film.height);
    height = std::max(1.0, std::round(width / aspect));
  }
  if (request.size) {
    width = request.size->width;
    height = request.size->height;
  }
  if (request.preview) {
    width = std::max(1.0, std::round(width / kPreviewShrink));
    height = std::max(1.0, std::round(height / kPreviewShrink));
  }
  if (const auto code = check_image_size(width, height, request.scene.limits, streams)) return code;
  film.width = static_cast<int>(width);
  film.height = static_cast<int>(height);
  return std::nullopt;
}

}  // namespace

std::optional<std::string> default_checkpoint(const RenderRequest& request) {
  const std::vector<std::string> files = paths_of(request.outputs);
  if (files.empty()) return std::nullopt;
  return files.front() + kCheckpointEnding;
}

std::optional<ExitCode> resolve_options(RenderRequest& request, const Streams& streams) {
  if (const auto code = check_together(request, streams)) return code;
  const auto marching = marching_of(request, streams);
  if (const auto* code = std::get_if<ExitCode>(&marching)) return *code;
  request.options.marching = std::get<runtime::Marching>(marching);
  put_flags(request);
  return std::nullopt;
}

std::optional<ExitCode> override_camera(const RenderRequest& request, compiler::CompiledScene& scene,
                                        const Streams& streams) {
  if (const auto code = override_fov(request, scene.camera, streams)) return code;
  return place_camera(request.camera, scene, streams);
}

std::optional<ExitCode> override_scene(RenderRequest& request, compiler::CompiledScene& scene,
                                       const Streams& streams) {
  scene.film = with_overrides(scene.film, request.options);
  scene.settings = with_overrides(scene.settings, request.options);
  if (request.denoise && scene.settings.spp < 2) {
    return fail(streams, kUsage, "a single sample a pixel cannot be denoised: its noise shows between samples",
                {request.preview ? "ask for --spp 2 or more, or --no-denoise" : "ask for --spp 2 or more"});
  }
  if (const auto code = override_size(request, scene.film, streams)) return code;
  if (const auto code = override_camera(request, scene, streams)) return code;
  if (const auto code = check_noise_threshold(request, scene, streams)) return code;
  if (const auto code = check_sample_range(request, scene, streams)) return code;
  if (!request.crop) return std::nullopt;
  const auto crop = crop_of(*request.crop, scene.film.width, scene.film.height, streams);
  if (const auto* code = std::get_if<ExitCode>(&crop)) return *code;
  request.options.crop = std::get<runtime::PixelRect>(crop);
  return std::nullopt;
}

}  // namespace fathom::cli
