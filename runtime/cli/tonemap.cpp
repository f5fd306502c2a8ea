// fathom tonemap: converts HDR values to a displayable image. From a render's OpenEXR file it makes, bit for bit, the
// image that the render itself would have written.
// Tested by: tests/runtime/cli/picture/cli_layers_test.cpp
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ostream>

#include "runtime/cli/input/memory.h"
#include "runtime/cli/input/scene_arguments.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/picture/image_attributes.h"
#include "runtime/cli/verbs.h"
#include "runtime/image/image_io.h"
#include "runtime/image/image_read.h"

namespace fathom::cli {
namespace {

constexpr const char* kTonemapExamples =
    "fathom tonemap render.exr -o out.png                      # as the scene says\n"
    "fathom tonemap render.exr -o out.png --exposure 1.5 --tone agx --bits 16\n"
    "fathom tonemap render.exr -o normal.png --layer normal";

struct TonemapRequest {
  std::string input;
  std::optional<Output> output;
  int format = -1;  // format of -o -, see apply_format()
  std::optional<double> exposure;
  int tone = -1;  // a compiler::ToneCurve; -1: not given
  int layer = 0;  // a runtime::Layer
  int bits = 0;   // an index into 8, 16
  compiler::Limits limits;
};

std::vector<std::string_view> layer_names() {
  std::vector<std::string_view> names;
  for (const runtime::LayerInfo& layer : runtime::kLayers) names.push_back(layer.name);
  return names;
}

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, TonemapRequest& request) {
  Arguments arguments("tonemap", "Converts the numbers of a render to a picture.", kTonemapExamples);
  arguments.positional("picture", "File to read: " + runtime::image_endings(), request.input);
  arguments.option("-o,--output", "FILE", "Picture to write: .png, .jpg, .jpeg or .bmp; - is standard output",
                   into(read_display_output, request.output));
  add_format_option(arguments, true, request.format);
  arguments.option("--exposure", "STOPS", "Brightness of the picture in stops: 1 doubles it (the file's, or 0)",
                   into(read_exposure, request.exposure));
  arguments.option("--tone", "CURVE", "Tone curve: none, filmic, aces, agx or neutral (the file's, or none)",
                   one_of({compiler::kToneCurves.begin(), compiler::kToneCurves.end()}, request.tone));
  arguments.option("--layer", "LAYER", "Layer to show: beauty (default), albedo, depth, normal or noisy",
                   one_of(layer_names(), request.layer));
  arguments.option("--bits", "N", "Bits per channel in png: 8 or 16 (8)", one_of({"8", "16"}, request.bits));
  add_limit_option(arguments, request.limits);
  if (const auto code = arguments.parse(args, streams)) return code;
  if (!request.output) return fail(streams, kUsage, "no picture to write", {"name it with -o FILE"});
  if (const auto code = apply_format({&*request.output, 1}, request.format, streams)) return code;
  const bool light = runtime::is_light(runtime::kLayers[static_cast<std::size_t>(request.layer)].layer);
  if (!light && (request.exposure || request.tone >= 0)) {
    return fail(streams, kUsage, "--exposure and --tone are about light: they do not go with another --layer");
  }
  if (request.bits != 0 && !request.output->format->deep) {
    return fail(streams, kUsage,
                fmt::format("--bits 16: {} can have only 8 bits per channel", request.output->format->ending),
                {"16 bits go into png"});
  }
  return std::nullopt;
}

runtime::ImageOptions options_of(const TonemapRequest& request, const runtime::FloatImage& image) {
  runtime::ImageOptions options{tone_in(image.attributes), request.bits == 0 ? 8 : 16};
  if (request.exposure) options.tone.exposure = *request.exposure;
  if (request.tone >= 0) options.tone.curve = static_cast<compiler::ToneCurve>(request.tone);
  return options;
}

}  // namespace

int run_tonemap(std::span<const std::string> args, const Streams& streams) {
  TonemapRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  streams.files.add_input(request.input);
  if (const auto code = check_outputs({&*request.output, 1}, streams)) return *code;
  const auto read = runtime::read_image(request.input, read_limits(request.limits));
  if (const auto* read_error = std::get_if<runtime::ImageReadError>(&read)) {
    return fail(streams, read_error->missing ? kIo : kBadScene, read_error->problem);
  }
  const auto& image = std::get<runtime::FloatImage>(read);
  const runtime::LayerInfo& layer = runtime::kLayers[static_cast<std::size_t>(request.layer)];
  const auto values = runtime::layer_of(image, layer.layer);
  if (!values) {
    return fail(streams, kBadScene,
                fmt::format("`{}` has no layer `{}`, which is made of {}", request.input, layer.name,
                            fmt::join(layer.channels, ", ")),
                {"its channels: " + runtime::channel_names(image)});
  }
  if (const auto problem = runtime::not_finite(*values)) {
    warn(streams, fmt::format("`{}` has {}: NaN is shown as black", request.input, *problem));
  }
  const Fill fill = [&](runtime::AtomicFile& file) {
    return runtime::write_layer(*values, options_of(request, image), request.output->format->format, file);
  };
  if (const auto problem = write_to(*request.output, fill, streams)) return fail(streams, kIo, *problem);
  say(streams, wrote(*request.output, image.area.width(), image.area.height()));
  return kDone;
}

}  // namespace fathom::cli
