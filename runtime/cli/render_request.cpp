#include "runtime/cli/render_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/adaptive.h"
#include "runtime/cli/checkpoint.h"
#include "runtime/cli/cost_map.h"
#include "runtime/cli/sequence.h"
#include "runtime/cli/standard_output.h"
#include "runtime/image_io.h"

namespace fathom::cli {
namespace {

constexpr const char* kRenderExamples =
    "fathom render scene.json -o out.png\n"
    "fathom render scene.json -o out.png -r 1920 --aspect 16:9 -s 256\n"
    "fathom render scene.json -o out.png -a -d -n          # and out-albedo.png, ...\n"
    "fathom render scene.json -o out.exr -o out.png --tone agx\n"
    "fathom render scene.json -o - --size 64x64 | display  # PNG to a program\n"
    "fathom render scene.json -o out.png -s 64 --denoise   # and out-noisy.png\n"
    "fathom render scene.json --preview --watch            # again when it is saved\n"
    "fathom render scene.json --profile --cost-map cost.png\n"
    "fathom render scene.json -s 4096 --resume             # continues a render\n"
    "fathom render scene.json -s 64 --sample-range 32:64 -o b.film   # a part\n"
    "fathom render hop.fathom --frames 0:192 --fps 24 -o frames/hop.png   # and hop-0001.png, ...";

// --preview divides each side by this.
constexpr int kPreviewShrink = 4;
constexpr int kPreviewSpp = 4;

void add_output_options(Arguments& arguments, RenderRequest& request) {
  arguments.group("Output");
  arguments.option(
      "-o,--output", "FILE",
      "Picture to write: .png, .jpg, .jpeg, .bmp; numbers: .exr (all layers), .pfm, .hdr; sums for "
      "`fathom merge`: .film; - is standard output; with --frames #### is the frame's number, and DIR/ a folder of "
      "pictures in --format; may be repeated (the scene's name with .png)",
      append_to(read_frame_output, request.outputs));
  add_format_option(arguments, false, request.format);
  arguments.option("-r,--res,--resolution", "WIDTH", "Width in pixels; the height follows from the aspect ratio",
                   whole(request.resolution, 1, compiler::kMaxSide));
  arguments.option("--aspect", "W:H", "Aspect ratio, width to height, as 16:9 or 4x3; the width stays",
                   into(read_aspect, request.aspect));
  arguments.option("--size", "WxH", "Width and height in pixels, as 1920x1080", into(read_size, request.size));
  arguments.option("--crop", "X0,Y0,X1,Y1",
                   "Render only this rectangle, in pixels or percent, X1 and Y1 exclusive: 25%,25%,75%,75%",
                   into(read_crop, request.crop));
  arguments.option("--exposure", "STOPS", "Brightness of the picture in stops: 1 doubles it (the scene's)",
                   into(read_exposure, request.exposure));
  arguments.option("--tone", "CURVE", "Tone curve: none, filmic, aces, agx or neutral (the scene's)",
                   one_of({compiler::kToneCurves.begin(), compiler::kToneCurves.end()}, request.tone));
  arguments.option("--bits", "N", "Bits per channel in png: 8 or 16 (8)", one_of({"8", "16"}, request.bits));
  arguments.flag("-a,--albedo", "Also write FILE-albedo: the colours of the surfaces without light", request.albedo);
  arguments.flag("-d,--depth", "Also write FILE-depth: the distances from the camera; near is white, far is dark",
                 request.depth);
  arguments.flag("-n,--normal", "Also write FILE-normal: the directions of the surfaces", request.normal);
  arguments.option("--cost-map", "FILE",
                   "Also write FILE-evaluations and FILE-instructions: the cost of each pixel, as colours (.png, "
                   ".jpg, .jpeg, .bmp) or numbers (.pfm)",
                   into(read_map_name, request.cost_map));
  arguments.option("--stats-json", "FILE", "Write the counts and times of the render as JSON; - is standard output",
                   any_text(request.stats_json));
  arguments.flag("--profile",
                 "Measure the time of each stage (march, resolve, normals, shading, film); print it with all counts",
                 request.options.profile);
}

Verdict read_filter_width(std::string_view text, double& width) {
  const std::optional<double> number = to_number(text);
  if (!number || *number < compiler::kMinFilterWidth || *number > compiler::kMaxFilterWidth) {
    return Complaint{
        fmt::format("`{}` is not a number from {} to {}", text, compiler::kMinFilterWidth, compiler::kMaxFilterWidth),
        "pixels, from one side of the filter to the other"};
  }
  width = *number;
  return std::nullopt;
}

void add_renderer_options(Arguments& arguments, RenderRequest& request) {
  runtime::RenderOptions& options = request.options;
  arguments.group("Renderer (the scene's values come before the defaults shown)");
  arguments.option("-s,--spp", "N", "Samples per pixel (16)", whole(options.spp, 1, compiler::kMaxSpp));
  arguments.option("-b,--bounces", "N", "Bounces before Russian roulette may end a path (10)",
                   whole(options.bounces, 0, compiler::kMaxBounces));
  arguments.option("-f,--fov", "ANGLE", "Horizontal field of view, as 45deg, 0.785rad or 0.785 (45deg)",
                   into(read_angle, request.fov));
  arguments.option("-t,--tile", "SIZE", "Max side of a tile in pixels (16); never changes the picture",
                   whole(options.tile, 1, compiler::kMaxTile));
  arguments.option("--seed", "N", "Seed of the random numbers (0)", into(read_seed, options.seed));
  arguments.option("--sampler", "KIND",
                   "Sampler: blue (default), whose errors cancel between neighbouring pixels, sobol or independent",
                   one_of({compiler::kSamplerNames.begin(), compiler::kSamplerNames.end()}, request.sampler));
  arguments.option("--filter", "NAME", "Pixel filter: box (default), tent, gaussian, blackman-harris or mitchell",
                   one_of({compiler::kFilterNames.begin(), compiler::kFilterNames.end()}, request.filter));
  arguments.option("--filter-width", "PIXELS", "Width of the pixel filter (box 1, tent 2, mitchell 4, others 3)",
                   into(read_filter_width, options.filter_width));
  arguments.flag("--adaptive", "Give noisy pixels more samples; --spp, 8 or more, is the average; not with --crop",
                 request.adaptive);
  arguments.flag("--no-adaptive", "Give all pixels the same number of samples, whatever the scene says",
                 request.no_adaptive);
  arguments.option("--clamp", "RADIANCE",
                   "Max radiance of light that comes by two bounces or more: removes bright specks, and with them "
                   "some light (no max)",
                   into(read_positive, options.clamp));
  arguments.option("--far", "DISTANCE", "End rays at this distance from the camera, in scene units",
                   into(read_positive, options.far));
}

// How the work is done; of the same group.
void add_running_options(Arguments& arguments, RenderRequest& request, bool& no_denoise) {
  arguments.option("--threads", "N", "Number of threads (one per processor); never changes the picture",
                   whole(request.threads, 1, 4096));
  arguments.flag("--denoise",
                 "Denoise the picture; the noisy one goes to FILE-noisy, in .exr to the channels noisy.*",
                 request.denoise);
  arguments.flag("--no-denoise", "Do not denoise; the default without --preview", no_denoise);
  arguments.flag("--preview",
                 "Render a quarter of the width and height, denoised, with 4 samples per pixel unless --spp is given",
                 request.preview);
  arguments.flag("--watch", "Render again whenever the scene's file changes; Ctrl-C ends (status 130)",
                 request.watch);
}

std::vector<std::string_view> method_names() {
  std::vector<std::string_view> names;
  for (const runtime::MethodInfo& method : runtime::kMethods) names.push_back(method.name);
  return names;
}

Verdict read_relaxation(std::string_view text, double& factor) {
  const std::optional<double> number = to_number(text);
  if (!number || !(*number >= 1 && *number < 2))
    return Complaint{fmt::format("`{}` is not a number in [1, 2)", text), "1 is plain sphere tracing"};
  factor = *number;
  return std::nullopt;
}

void add_comparing_options(Arguments& arguments, RenderRequest& request) {
  arguments.group("Light (for comparisons; the default is right for pictures)");
  arguments.option(
      "--light-sampling", "WAY",
      "How paths find light: both (default), lights (by shadow rays alone) or hits (by meeting lamps alone)",
      one_of({runtime::kLightSamplingNames.begin(), runtime::kLightSamplingNames.end()}, request.light_sampling));
}

void add_marching_options(Arguments& arguments, RenderRequest& request) {
  arguments.group("Ray marching (for comparisons; the defaults are right for pictures)");
  arguments.option("--march", "METHOD",
                   "Method: tiered (default), sphere, relaxed, automatic or certified; see docs/ACCURACY.md",
                   one_of(method_names(), request.method));
  arguments.flag("--reference", "Search every ray in double precision; the same as --march certified",
                 request.reference);
  arguments.option("--epsilon", "DISTANCE",
                   "Distance that counts as a hit, in scene units (1e-4); for sphere, relaxed and automatic",
                   into(read_positive, request.epsilon));
  arguments.flag("--no-regions", "Build no regions: evaluate the whole program everywhere, however large the scene",
                 request.no_regions);
  arguments.option("--region-memory", "MB", "Max memory of regions (64)", whole(request.region_memory, 1, 1 << 20));
  arguments.option("--max-steps", "N", "Max evaluations per ray (512); for sphere, relaxed and automatic",
                   whole(request.steps, 1, 1 << 20));
  arguments.option("--relaxation", "FACTOR", "Step length in safe radii, from 1 to below 2 (1.6); for relaxed",
                   into(read_relaxation, request.relaxation));
  arguments.option("--precision", "NUMBER",
                   "Precision: f32 (default) or f64; not for certified, which computes in double",
                   one_of({"f32", "f64"}, request.precision));
}

// The marching asked for, or the exit code after a message about options that do not go together.
std::variant<runtime::Marching, ExitCode> marching_of(const RenderRequest& request, const Streams& streams) {
  runtime::Marching marching;
  if (request.method >= 0) marching.method = runtime::kMethods[request.method].method;
  if (request.reference) {
    if (request.method >= 0 && marching.method != runtime::Method::Certified) {
      return fail(streams, kUsage, "--reference is --march certified; it does not go with another method");
    }
    marching.method = runtime::Method::Certified;
  }
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

// The crop's pixels, or the exit code after a message.
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

// Of what shares samples out; a scene that asks for it and has too few samples goes without.
std::optional<ExitCode> check_adaptive(const RenderRequest& request, const compiler::CompiledScene& scene,
                                       const Streams& streams) {
  const int spp = request.options.spp.value_or(scene.settings.spp);
  if (request.adaptive && spp < runtime::kLeastAdaptiveSpp) {
    return fail(streams, kUsage,
                fmt::format("--adaptive: {} a pixel are too few to share out",
                            count_of(static_cast<std::size_t>(spp), "sample")),
                {fmt::format("ask for --spp {} or more", runtime::kLeastAdaptiveSpp)});
  }
  if (!request.crop || !request.options.adaptive.value_or(scene.settings.adaptive)) return std::nullopt;
  return fail(
      streams, kUsage,
      request.adaptive ? "--crop does not go with --adaptive: a pixel's samples depend on the whole picture"
                       : "--crop: the scene's `adaptive` makes a pixel's samples depend on the whole picture",
      {request.adaptive ? "leave out --adaptive, or render the whole" : "add --no-adaptive, or render the whole"});
}

std::optional<ExitCode> check_watch(const RenderRequest& request, const Streams& streams) {
  if (!request.watch) return std::nullopt;
  if (request.scene.path == "-") {
    return fail(streams, kUsage, "--watch: standard input cannot change", {"name the scene's file"});
  }
  const LongRender& asked = request.long_render;
  if (asked.checkpoint || asked.interval || asked.resume) {
    return fail(streams, kUsage, "--watch begins again with every change: it goes with no checkpoint",
                {"leave out --checkpoint, --checkpoint-interval and --resume"});
  }
  return std::nullopt;
}

// Of options that do not go together, whatever the scene.
std::optional<ExitCode> check_together(const RenderRequest& request, bool no_denoise, const Streams& streams) {
  if (request.size && (request.resolution || request.aspect)) {
    return fail(streams, kUsage, "--size gives width and height; it does not go with --resolution or --aspect");
  }
  if (request.quiet && request.verbosity > 0) return fail(streams, kUsage, "--quiet does not go with --verbose");
  if (request.quiet && request.options.profile && !request.stats_json) {
    return fail(streams, kUsage, "--quiet leaves out the numbers that --profile adds to",
                {"leave out --quiet, or ask for --stats-json FILE"});
  }
  if (const auto code = check_watch(request, streams)) return code;
  if (request.denoise && no_denoise) return fail(streams, kUsage, "--denoise does not go with --no-denoise");
  if (request.adaptive && request.no_adaptive) {
    return fail(streams, kUsage, "--adaptive does not go with --no-adaptive");
  }
  return std::nullopt;
}

// What the flags mean for the renderer.
void settle(RenderRequest& request, bool no_denoise) {
  runtime::RenderOptions& options = request.options;
  if (request.preview) {
    request.denoise = !no_denoise;
    if (!options.spp) options.spp = kPreviewSpp;
  }
  options.layers = {.first_hit = request.albedo || request.depth || request.normal,
                    .cost = request.cost_map.has_value()};
  if (std::any_of(request.outputs.begin(), request.outputs.end(), [](const Output& o) { return o.layers(); })) {
    options.layers = runtime::kAllLayers;
  }
  if (request.denoise) options.layers.first_hit = options.layers.halves = true;
  options.threads = request.threads.value_or(0);
  if (request.adaptive || request.no_adaptive) options.adaptive = request.adaptive;
  if (request.light_sampling >= 0) {
    options.light_sampling = static_cast<runtime::LightSampling>(request.light_sampling);
  }
  if (request.sampler >= 0) options.sampler = static_cast<compiler::SamplerKind>(request.sampler);
  if (request.filter >= 0) options.filter = static_cast<compiler::FilterKind>(request.filter);
  options.regions = !request.no_regions;
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
  if (const auto code = check_picture_size(width, height, request.scene.limits, streams)) return code;
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

std::variant<RenderRequest, int> parse_render(std::span<const std::string> args, const Streams& streams) {
  RenderRequest request;
  Arguments arguments("render", "Renders a scene to image files.", kRenderExamples);
  add_scene_arguments(arguments, request.scene);
  arguments.counter("-v,--verbose",
                    "Print all counts of the render; more about the scene with each further v, up to -vvvvvv",
                    request.verbosity);
  arguments.flag("-q,--quiet", "Print only errors, warnings and notes", request.quiet);
  add_output_options(arguments, request);
  add_camera_options(arguments, request.camera);
  bool no_denoise = false;
  add_renderer_options(arguments, request);
  add_running_options(arguments, request, no_denoise);
  add_motion_options(arguments, request.frames);
  add_long_render_options(arguments, request.long_render);
  add_comparing_options(arguments, request);
  add_marching_options(arguments, request);
  if (const auto code = arguments.parse(args, streams)) return *code;

  if (request.outputs.empty()) {
    request.outputs.push_back(default_output(request.scene.path));
    request.default_output = true;
  }
  if (const auto code = put_formats(request.outputs, request.format, streams)) return *code;
  if (const auto code = check_standard_output(request, streams)) return *code;
  if (const auto code = check_frames(request, streams)) return *code;
  if (const auto code = check_together(request, no_denoise, streams)) return *code;
  const auto marching = marching_of(request, streams);
  if (const auto* code = std::get_if<ExitCode>(&marching)) return *code;
  request.options.marching = std::get<runtime::Marching>(marching);
  settle(request, no_denoise);
  return request;
}

std::optional<ExitCode> override_camera(const RenderRequest& request, compiler::CompiledScene& scene,
                                        const Streams& streams) {
  if (const auto code = override_fov(request, scene.camera, streams)) return code;
  return place_camera(request.camera, scene, streams);
}

std::optional<ExitCode> override_scene(RenderRequest& request, compiler::CompiledScene& scene,
                                       const Streams& streams) {
  if (request.denoise && request.options.spp.value_or(scene.settings.spp) < 2) {
    return fail(streams, kUsage, "a single sample a pixel cannot be denoised: its noise shows between samples",
                {request.preview ? "ask for --spp 2 or more, or --no-denoise" : "ask for --spp 2 or more"});
  }
  if (const auto code = override_size(request, scene.film, streams)) return code;
  if (const auto code = override_camera(request, scene, streams)) return code;
  scene.film.exposure = request.exposure.value_or(scene.film.exposure);
  if (request.tone >= 0) scene.film.tone = static_cast<compiler::ToneCurve>(request.tone);
  if (const auto code = check_adaptive(request, scene, streams)) return code;
  if (const auto code = apply(request.long_render, scene, request.options, streams)) return code;
  if (!request.crop) return std::nullopt;
  if (request.options.noise) {
    return fail(streams, kUsage, "--crop does not go with --noise, which judges tiles of the whole picture",
                {"leave out --noise, or render the whole"});
  }
  const auto crop = crop_of(*request.crop, scene.film.width, scene.film.height, streams);
  if (const auto* code = std::get_if<ExitCode>(&crop)) return *code;
  request.options.crop = std::get<runtime::PixelRect>(crop);
  return std::nullopt;
}

}  // namespace fathom::cli
