// fathom diff: measures the difference between two images, as numbers and as a map.
//
//     $ fathom diff out.png reference.png
//     mse      0.0012
//     relmse   0.0085
//     max      0.31
//     mean    -0.0002
//     flip     0.041
//
// Tested by: tests/runtime/cli/cli_diff_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <ostream>

#include "runtime/chart/colormap.h"
#include "runtime/cli/input/memory.h"
#include "runtime/cli/input/scene_arguments.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/verbs.h"
#include "runtime/image/flip.h"
#include "runtime/image/image_io.h"
#include "runtime/image/image_read.h"

namespace fathom::cli {
namespace {

constexpr const char* kDiffExamples =
    "fathom diff out.png reference.png\n"
    "fathom diff out.exr reference.exr --metric relmse --tol 0.01   # status 1?\n"
    "fathom diff out.png reference.png -o where.png   # FLIP of each pixel\n"
    "\n"
    "mse, relmse, max and mean compare linear light. mean is the first picture minus the second. relmse divides by "
    "the\n"
    "square of the second. flip is the difference that an eye sees on a screen, from 0 to 1.";

// Memory for the colours of both images and the planes of FLIP, measured.
constexpr double kBytesPerPixel = 80;

// The metrics, and whether --tol can bound each of them.
struct Measured {
  runtime::Differences differences;
  runtime::Flip flip;
};
struct Metric {
  std::string_view name;
  double (*value)(const Measured& measured);
  bool bounded;
};
constexpr Metric kMetrics[] = {
    {"mse", [](const Measured& m) { return m.differences.mse; }, true},
    {"relmse", [](const Measured& m) { return m.differences.relmse; }, true},
    {"max", [](const Measured& m) { return m.differences.max; }, true},
    {"flip", [](const Measured& m) { return m.flip.mean; }, true},
    {"mean", [](const Measured& m) { return m.differences.mean; }, false},
};

struct DiffRequest {
  std::string first, second;
  std::optional<Output> map;
  int format = -1;  // format of -o -, see apply_format()
  std::optional<double> tolerance;
  compiler::Limits limits;
  int metric = -1;  // an index into kMetrics; -1: not given
  bool json = false;
};

// Returns the map's output as a span, empty if no map is requested.
std::span<Output> map_of(DiffRequest& request) {
  return request.map ? std::span<Output>(&*request.map, 1) : std::span<Output>();
}

OptionResult read_tolerance(std::string_view text, double& tolerance) {
  const std::optional<double> number = to_number(text);
  if (!number || *number < 0) return OptionError{fmt::format("`{}` is not a number from 0", text), ""};
  tolerance = *number;
  return std::nullopt;
}

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, DiffRequest& request) {
  std::vector<std::string_view> names;
  for (const Metric& metric : kMetrics) {
    if (metric.bounded) names.push_back(metric.name);
  }
  Arguments arguments("diff", "Compares a picture with a reference.", kDiffExamples);
  arguments.positional("picture", "Picture to judge", request.first);
  arguments.positional("reference", "Picture that it should equal", request.second);
  arguments.option("--tol", "X", "Exit with status 1 when the metric is above X",
                   into(read_tolerance, request.tolerance));
  arguments.option("--metric", "NAME", "Metric of --tol: mse (default), relmse, max or flip",
                   one_of(names, request.metric));
  arguments.option("-o,--output", "FILE",
                   "Also write a map of FLIP: violet is equal, yellow is different; - is standard output",
                   into(read_display_output, request.map));
  add_format_option(arguments, true, request.format);
  arguments.flag("--json", "Print the numbers as JSON", request.json);
  add_limit_option(arguments, request.limits);
  if (const auto code = arguments.parse(args, streams)) return code;
  if (request.metric >= 0 && !request.tolerance) {
    return fail(streams, kUsage, "--metric says what --tol is about; there is no --tol");
  }
  return apply_format(map_of(request), request.format, streams);
}

// Linear colours of an image file.
struct Colors {
  int width = 0, height = 0;
  std::vector<float> rgb;
  runtime::RgbView view() const { return {width, height, rgb}; }
};

std::variant<Colors, ExitCode> read_colors(const std::string& path, const compiler::Limits& limits,
                                           const Streams& streams) {
  const auto read = runtime::read_image(path, read_limits(limits));
  if (const auto* read_error = std::get_if<runtime::ImageReadError>(&read)) {
    return fail(streams, read_error->missing ? kIo : kBadScene, read_error->problem);
  }
  const auto& image = std::get<runtime::FloatImage>(read);
  const auto light = runtime::layer_of(image, runtime::Layer::Beauty);
  if (!light) {
    return fail(streams, kBadScene, fmt::format("`{}` has no channels R, G and B", path),
                {"its channels: " + runtime::channel_names(image)});
  }
  Colors colors{image.width, image.height, {}};
  colors.rgb.reserve(3 * image.area.pixels());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::vec3 color = light->at(x, y);
      colors.rgb.insert(colors.rgb.end(), {color.x, color.y, color.z});
    }
  }
  return colors;
}

std::string table(const Measured& measured) {
  std::string text;
  for (const Metric& metric : kMetrics) text += fmt::format("{:8}{:.6g}\n", metric.name, metric.value(measured));
  if (measured.differences.invalid > 0) text += fmt::format("{:8}{}\n", "invalid", measured.differences.invalid);
  return text;
}

std::string json(const Measured& measured) {
  nlohmann::ordered_json object;
  for (const Metric& metric : kMetrics) object[std::string(metric.name)] = metric.value(measured);
  object["invalid"] = measured.differences.invalid;
  return object.dump(2) + '\n';
}

runtime::ByteImage map_image(const runtime::Flip& flip, int width, int height) {
  runtime::ByteImage picture{width, height, {}};
  for (const float error : flip.map) {
    const runtime::Rgb color = runtime::viridis(static_cast<double>(error));
    picture.rgb.insert(picture.rgb.end(), color.begin(), color.end());
  }
  return picture;
}

// Returns kFoundProblems if the metric exceeds --tol.
ExitCode judge(const DiffRequest& request, const Measured& measured, const Streams& streams) {
  if (!request.tolerance) return kDone;
  if (measured.differences.invalid > 0) {
    return fail(streams, kFoundProblems,
                fmt::format("{} have values that are not finite", count_of(measured.differences.invalid, "pixel")));
  }
  const Metric& metric = kMetrics[std::max(0, request.metric)];
  const double value = metric.value(measured);
  if (value <= *request.tolerance) return kDone;
  return fail(streams, kFoundProblems,
              fmt::format("{} is {:.6g}, more than {:.6g}", metric.name, value, *request.tolerance));
}

}  // namespace

int run_diff(std::span<const std::string> args, const Streams& streams) {
  DiffRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  for (const std::string& read : {request.first, request.second}) streams.files.add_input(read);
  if (const auto code = check_outputs(map_of(request), streams)) return *code;
  const auto first = read_colors(request.first, request.limits, streams),
             second = read_colors(request.second, request.limits, streams);
  if (const auto* code = std::get_if<ExitCode>(&first)) return *code;
  if (const auto* code = std::get_if<ExitCode>(&second)) return *code;
  const Colors &picture = std::get<Colors>(first), &reference = std::get<Colors>(second);
  if (picture.width != reference.width || picture.height != reference.height) {
    return fail(streams, kBadScene,
                fmt::format("`{}` is {}x{} and `{}` is {}x{}", request.first, picture.width, picture.height,
                            request.second, reference.width, reference.height),
                {"only pictures of one size can be compared"});
  }
  const double pixels = static_cast<double>(picture.width) * picture.height, allowed = allowed_memory(request.limits);
  if (pixels * kBytesPerPixel > allowed) {
    return fail(streams, kBadScene,
                fmt::format("`{}` cannot be compared: {}", request.first,
                            runtime::too_much_memory(pixels * kBytesPerPixel, allowed)),
                {compiler::raise(&compiler::Limits::memory, pixels * kBytesPerPixel)});
  }
  const Measured measured{runtime::compare(picture.view(), reference.view()),
                          runtime::flip(picture.view(), reference.view())};
  const bool taken = request.map && request.map->standard();
  (taken ? streams.err : streams.out) << (request.json ? json(measured) : table(measured));
  if (request.map) {
    const runtime::ByteImage map = map_image(measured.flip, picture.width, picture.height);
    const Fill fill = [&](runtime::AtomicFile& file) {
      return runtime::write_image(map, request.map->format->format, file);
    };
    if (const auto problem = write_to(*request.map, fill, streams)) return fail(streams, kIo, *problem);
    say(streams, wrote(*request.map, map.width, map.height));
  }
  return judge(request, measured, streams);
}

}  // namespace fathom::cli
