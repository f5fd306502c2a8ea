// fathom slice: draws the field on a plane, as inside and outside or as distances.
//
//     $ fathom slice ball.json --show sign -o ball.png
//     inside 107968 of 262144 pixels
//
// Tested by: tests/runtime/cli/cli_slice_test.cpp
#include "runtime/slice/slice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "runtime/base/machine.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/verbs.h"
#include "runtime/image/image_io.h"
#include "vm/encoding/printable.h"

namespace fathom::cli {
namespace {

constexpr const char* kSliceExamples =
    "fathom slice scene.fathom -o out.png                  # from the front\n"
    "fathom slice scene.fathom -o out.png --axis y --at 0.5  # from above\n"
    "fathom slice scene.fathom --show sign --box -1,-1,1,1 --size 1024x1024\n"
    "\n"
    "Across z the picture's right is +x and its up is +y. Across y right is +x and up is -z. Across x right is -z\n"
    "and up is +y. --box takes x,y across z, x,z across y, z,y across x.";

enum Show { kSign, kDistance };

struct SliceRequest {
  SceneArguments scene;
  Output output;
  int axis = static_cast<int>(runtime::Axis::Z);
  int show = kDistance;
  std::optional<double> at;
  std::optional<Rectangle> box;
  std::optional<PixelSize> size;
  std::optional<int> threads;
};

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, SliceRequest& request) {
  std::optional<Output> output;
  int format = -1;
  Arguments arguments("slice", "Draws the field on a plane across one of the axes.", kSliceExamples);
  add_scene_arguments(arguments, request.scene);
  arguments.option(
      "-o,--output", "FILE",
      "Picture to write: .png, .jpg, .jpeg or .bmp; - is standard output (the scene's name with -slice.png)",
      into(read_display_output, output));
  add_format_option(arguments, true, format);
  arguments.option("--axis", "AXIS", "Axis perpendicular to the plane: x, y or z (z)",
                   one_of({"x", "y", "z"}, request.axis));
  arguments.option("--at", "OFFSET", "Position of the plane on that axis, in scene units (0)",
                   into(read_finite, request.at));
  arguments.option("--size", "WxH", "Width and height in pixels (512x512)", into(read_size, request.size));
  arguments.option("--box", "X0,Y0,X1,Y1", "Rectangle of the plane to show (the scene's bound, enlarged by a tenth)",
                   into(read_rectangle, request.box));
  arguments.option("--show", "WHAT", "distance (default): coloured bands; sign: white inside, black outside",
                   one_of({"sign", "distance"}, request.show));
  arguments.option("--threads", "N", "Number of threads (one per processor); never changes the picture",
                   whole(request.threads, 1, 4096));
  if (const auto code = arguments.parse(args, streams)) return code;

  if (!request.size) request.size = PixelSize{512, 512};
  if (const auto code = check_image_size(request.size->width, request.size->height, request.scene.limits, streams))
    return code;
  request.output = output.value_or(default_output(request.scene.path));
  const std::span<Output> named(&request.output, output ? 1 : 0);
  if (const auto code = apply_format(named, format, streams)) return *code;
  if (output) return std::nullopt;
  request.output.path = with_suffix(request.output.path, "slice");
  note(streams, fmt::format("the picture goes to {}; -o FILE chooses another name", request.output.path));
  return std::nullopt;
}

// Returns the requested slice in the programs' coordinates.
runtime::Slice place_slice(const SliceRequest& request, const compiler::CompiledScene& scene) {
  const auto axis = static_cast<runtime::Axis>(request.axis);
  const double at = request.at.value_or(0) - scene.origin[request.axis];
  runtime::Slice slice = runtime::frame_slice(scene.bound, axis, at, request.size->width, request.size->height);
  if (request.box) {
    slice.lo = request.box->lo - runtime::on_plane(axis, scene.origin);
    slice.hi = request.box->hi - runtime::on_plane(axis, scene.origin);
  }
  return slice;
}

// Returns the line printed for an image of the signs.
std::string count_inside(const std::vector<float>& field) {
  const auto inside = std::count_if(field.begin(), field.end(), [](float value) { return value < 0; });
  return fmt::format("inside {} of {} pixels\n", inside, field.size());
}

// Returns the line printed for an image of the distances.
std::string describe_bands(const std::vector<float>& field, double step) {
  float least = std::numeric_limits<float>::infinity(), most = -least;
  for (const float value : field) {
    least = std::min(least, value);  // ignores NaN, which is the second argument
    most = std::max(most, value);
  }
  return fmt::format("a line every {:.6g} scene units, distances from {} to {}\n", step, least, most);
}

// An image and its line of text. The line goes to standard output unless the image does.
struct Drawing {
  runtime::ByteImage picture;
  std::string line;
};

Drawing draw(const SliceRequest& request, const runtime::Slice& slice, const std::vector<float>& field) {
  if (request.show == kSign) return {runtime::sign_image(field, slice.width, slice.height), count_inside(field)};
  const double step = runtime::band_step(slice.hi.y - slice.lo.y);
  return {runtime::distance_image(field, slice.width, slice.height, step), describe_bands(field, step)};
}

void note_invalid(const std::vector<float>& field, const Streams& streams) {
  const auto invalid = std::count_if(field.begin(), field.end(), [](float value) { return std::isnan(value); });
  if (invalid > 0) note(streams, fmt::format("{} of {} values are not a number", invalid, field.size()));
}

}  // namespace

int run_slice(std::span<const std::string> args, const Streams& streams) {
  SliceRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  if (const auto code = check_outputs({&request.output, 1}, streams)) return *code;
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  const auto compiled = compile_scene(std::get<SceneInput>(std::move(source)), request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  const auto& scene = std::get<compiler::CompiledScene>(compiled);

  const runtime::Slice slice = place_slice(request, scene);
  const int threads = request.threads ? *request.threads : runtime::usable_processors();
  const auto wanted = request.show == kSign ? runtime::SliceValues::Sign : runtime::SliceValues::Exact;
  const std::vector<float> field =
      runtime::evaluate_slice(scene.distance, slice, threads, wanted);
  note_invalid(field, streams);
  const Drawing drawing = draw(request, slice, field);
  const Fill fill = [&](runtime::AtomicFile& file) {
    return runtime::write_image(drawing.picture, request.output.format->format, file);
  };
  if (const auto problem = write_to(request.output, fill, streams)) return fail(streams, kIo, *problem);
  if (request.output.standard()) {
    streams.err << vm::printable(drawing.line);
  } else {
    print(streams, drawing.line);
  }
  say(streams, wrote(request.output, slice.width, slice.height));
  return kDone;
}

}  // namespace fathom::cli
