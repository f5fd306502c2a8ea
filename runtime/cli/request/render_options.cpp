#include "runtime/cli/request/render_options.h"

#include <fmt/format.h>

#include "runtime/cli/options/setting_options.h"
#include "runtime/cli/request/request_checks.h"

namespace fathom::cli {
namespace {

constexpr const char* kRenderExamples =
    "fathom render scene.fathom -o out.png\n"
    "fathom render scene.fathom -o out.png -r 1920 --aspect 16:9 -s 256\n"
    "fathom render scene.fathom -o out.png -a -d -n        # and out-albedo.png, ...\n"
    "fathom render scene.fathom -o out.exr -o out.png --tone agx\n"
    "fathom render scene.fathom -o - --size 64x64 | display  # PNG to a program\n"
    "fathom render scene.fathom -o out.png -s 64 --denoise # and out-noisy.png\n"
    "fathom render scene.fathom --preview --watch          # again when it is saved\n"
    "fathom render scene.fathom --profile --cost-map cost.png\n"
    "fathom render scene.fathom -s 4096 --resume           # continues a render\n"
    "fathom render scene.fathom -s 64 --sample-range 32:64 -o b.film # a part\n"
    "fathom render hop.fathom --frames 0:192 --fps 24 -o frames/hop.png   # and hop-0001.png, ...";

void add_verbosity_options(Arguments& arguments, RenderRequest& request) {
  arguments.counter("-v,--verbose",
                    "Print all counts of the render; more about the scene with each further v, up to -vvvvvv",
                    request.verbosity);
  arguments.flag("-q,--quiet", "Print only errors, warnings and notes", request.quiet);
}

void add_profile_option(Arguments& arguments, RenderRequest& request) {
  arguments.flag("--profile",
                 "Measure the time of each stage (march, certify, normals, shading, film); print it with all counts",
                 request.options.profile);
}

void add_threads_option(Arguments& arguments, RenderRequest& request) {
  arguments.option("--threads", "N", "Number of threads (one per processor); never changes the picture",
                   whole(request.options.threads, 1, 4096));
}

void add_file_options(Arguments& arguments, RenderRequest& request) {
  arguments.group("Output");
  arguments.option(
      "-o,--output", "FILE",
      "Picture to write: .png, .jpg, .jpeg, .bmp; numbers: .exr (all layers), .pfm, .hdr; sums for "
      "`fathom merge`: .film; - is standard output; with --frames #### is the frame's number, and DIR/ a folder of "
      "pictures in --format; may be repeated (the scene's name with .png)",
      append_to(read_frame_output, request.outputs));
  add_format_option(arguments, false, request.format);
  arguments.option("--crop", "X0,Y0,X1,Y1",
                   "Render only this rectangle, in pixels or percent, X1 and Y1 exclusive: 25%,25%,75%,75%",
                   into(read_crop, request.crop));
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
  add_profile_option(arguments, request);
}

// Adds the options of the image in the files, to the current group.
void add_film_options(Arguments& arguments, RenderRequest& request) {
  arguments.option("-r,--res,--resolution", "WIDTH", "Width in pixels; the height follows from the aspect ratio",
                   whole(request.resolution, 1, compiler::kMaxSide));
  arguments.option("--aspect", "W:H", "Aspect ratio, width to height, as 16:9 or 4x3; the width stays",
                   into(read_aspect, request.aspect));
  arguments.option("--size", "WxH", "Width and height in pixels, as 1920x1080", into(read_size, request.size));
  add_setting_options(arguments, compiler::OptionGroup::Picture, request.options);
}

void add_renderer_options(Arguments& arguments, RenderRequest& request) {
  arguments.group("Renderer (the scene's values come before the defaults shown)");
  const auto add_after = [&](std::string_view setting) {
    if (setting == "rr_depth") {
      arguments.option("-f,--fov", "ANGLE", "Horizontal field of view, as 45deg, 0.785rad or 0.785 (45deg)",
                       into(read_angle, request.fov));
    } else if (setting == "noise_threshold") {
      arguments.flag("--uniform", "Give all pixels the same number of samples, whatever the scene says",
                     request.options.uniform);
    }
  };
  add_setting_options(arguments, compiler::OptionGroup::Renderer, request.options, add_after);
}

// Adds the options of how the work is done, to the current group.
void add_running_options(Arguments& arguments, RenderRequest& request) {
  add_threads_option(arguments, request);
  arguments.flag("--watch", "Render again whenever the scene's file changes; Ctrl-C ends (status 130)",
                 request.watch);
}

void add_denoise_options(Arguments& arguments, RenderRequest& request) {
  arguments.flag("--denoise",
                 "Denoise the picture; the noisy one goes to FILE-noisy, in .exr to the channels noisy.*",
                 request.denoise);
  arguments.flag("--no-denoise", "Do not denoise; the default without --preview", request.no_denoise);
  arguments.flag("--preview",
                 "Render a quarter of the width and height, denoised, with 4 samples per pixel unless --spp is given",
                 request.preview);
}

OptionResult read_sample_range(std::string_view text, runtime::SampleRange& range) {
  NumberRange numbers{};
  if (OptionResult error = read_range(text, "samples", compiler::kMaxSpp, numbers)) return error;
  range = {static_cast<std::uint32_t>(numbers.first), static_cast<std::uint32_t>(numbers.second)};
  return std::nullopt;
}

OptionResult read_file_name(std::string_view text, std::string& name) {
  if (text.empty()) return OptionError{"the file's name is empty", "name it, as now.film"};
  name = text;
  return std::nullopt;
}

void add_interval_option(Arguments& arguments, RenderRequest& request) {
  arguments.option("--checkpoint-interval", "TIME",
                   "Time between checkpoints, as 30s, 5m or 1h (60s; of units of a plan 10m)",
                   into(read_duration, request.checkpoint_interval));
}

void add_long_render_options(Arguments& arguments, RenderRequest& request) {
  arguments.group("Long renders (docs/how-to/render.md)");
  arguments.option("--checkpoint", "FILE",
                   "File that keeps the samples so far, written at intervals and when a signal or --time-limit ends "
                   "the render (the first output's name with .checkpoint, which goes when the render is done)",
                   into(read_file_name, request.checkpoint));
  add_interval_option(arguments, request);
  arguments.flag("--resume",
                 "Continue from the checkpoint; the picture has the same bits as without the interruption",
                 request.resume);
  arguments.option("--time-limit", "TIME",
                   "End the render after this time, as 30s, 10m or 1.5h, and write the picture so far",
                   into(read_duration, request.options.time_limit));
  arguments.option("--sample-range", "A:B",
                   "Take only samples A to B-1 of each pixel's --spp: a part for `fathom merge`",
                   into(read_sample_range, request.options.sample_range));
}

std::vector<std::string_view> method_names() {
  std::vector<std::string_view> names;
  for (const runtime::MethodInfo& method : runtime::kMethods) names.push_back(method.name);
  return names;
}

OptionResult read_relaxation(std::string_view text, double& factor) {
  const std::optional<double> number = to_number(text);
  if (!number || !(*number >= 1 && *number < 2))
    return OptionError{fmt::format("`{}` is not a number in [1, 2)", text), "1 is plain sphere tracing"};
  factor = *number;
  return std::nullopt;
}

void add_comparing_options(Arguments& arguments, RenderRequest& request) {
  arguments.group("Light (for comparisons; the default is right for pictures)");
  add_setting_options(arguments, compiler::OptionGroup::Light, request.options);
}

void add_marching_options(Arguments& arguments, RenderRequest& request) {
  arguments.group("Ray marching (for comparisons; the defaults are right for pictures)");
  arguments.option("--march", "METHOD",
                   "Method: tiered (default), sphere, relaxed, automatic or certified; see "
                   "docs/explanation/accuracy.md",
                   one_of(method_names(), request.method));
  arguments.option("--epsilon", "DISTANCE",
                   "Distance that counts as a hit, in scene units (1e-4); for sphere, relaxed and automatic",
                   into(read_positive, request.epsilon));
  arguments.flag("--no-regions", "Build no regions: evaluate the whole program everywhere, however large the scene",
                 request.no_regions);
  arguments.flag("--no-native", "Interpret programs, do not compile them to machine code; the picture is the same",
                 request.no_native);
  arguments.option("--region-memory", "MB", "Max memory of regions (128)", whole(request.region_memory, 1, 1 << 20));
  arguments.option("--max-steps", "N", "Max evaluations per ray (512); for sphere, relaxed and automatic",
                   whole(request.steps, 1, 1 << 20));
  arguments.option("--relaxation", "FACTOR", "Step length in safe radii, from 1 to below 2 (1.6); for relaxed",
                   into(read_relaxation, request.relaxation));
  arguments.option("--precision", "NUMBER",
                   "Precision: f32 (default) or f64; not for certified, which computes in double",
                   one_of({"f32", "f64"}, request.precision));
}

}  // namespace

void add_image_options(Arguments& arguments, RenderRequest& request) {
  add_film_options(arguments, request);
  add_camera_options(arguments, request.camera);
  add_renderer_options(arguments, request);
  add_denoise_options(arguments, request);
  add_motion_options(arguments, request.frames);
  add_comparing_options(arguments, request);
  add_marching_options(arguments, request);
}

std::variant<RenderRequest, ExitCode> parse_planned(std::span<const std::string> planned,
                                                    std::span<const std::string> running, const Streams& streams) {
  RenderRequest request;
  Arguments of_plan("plan", "", "");
  add_define_option(of_plan, request.scene);
  add_image_options(of_plan, request);
  if (of_plan.parse(planned, streams)) return kBadScene;
  Arguments of_run("render", "", "");
  add_verbosity_options(of_run, request);
  add_threads_option(of_run, request);
  add_profile_option(of_run, request);
  add_interval_option(of_run, request);
  add_error_format_option(of_run, request.scene);
  add_limit_option(of_run, request.scene.limits);
  if (of_run.parse(running, streams)) return kUsage;
  if (const auto code = resolve_options(request, streams)) return *code;
  request.options.layers = runtime::kAllLayers;
  if (request.denoise) request.options.layers.halves = true;
  return request;
}

std::variant<RenderRequest, int> parse_render(std::span<const std::string> args, const Streams& streams) {
  RenderRequest request;
  Arguments arguments("render", "Renders a scene to image files.", kRenderExamples);
  add_scene_arguments(arguments, request.scene, false);
  add_verbosity_options(arguments, request);
  add_file_options(arguments, request);
  add_film_options(arguments, request);
  add_camera_options(arguments, request.camera);
  add_renderer_options(arguments, request);
  add_denoise_options(arguments, request);
  add_running_options(arguments, request);
  add_motion_options(arguments, request.frames);
  add_long_render_options(arguments, request);
  add_unit_options(arguments, request.units);
  add_comparing_options(arguments, request);
  add_marching_options(arguments, request);
  if (const auto code = arguments.parse(args, streams)) return *code;
  if (request.units.given()) {
    if (const auto code = check_units(request.units, arguments.parsed_options(), streams)) return *code;
    return request;
  }
  if (request.scene.path.empty()) {
    return fail(streams, kUsage, "the scene is missing", {"`fathom render --help` lists the options"});
  }
  if (request.outputs.empty()) {
    request.outputs.push_back(default_output(request.scene.path));
    request.default_output = true;
  }
  if (const auto code = apply_format(request.outputs, request.format, streams)) return *code;
  if (const auto code = check_standard_output(request, streams)) return *code;
  if (const auto code = check_frames(request, streams)) return *code;
  if (const auto code = resolve_options(request, streams)) return *code;
  return request;
}

}  // namespace fathom::cli
