#include "runtime/cli/options/output_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <system_error>

#include "compiler/scene/compiled_scene.h"
#include "runtime/base/atomic_file.h"
#include "runtime/image/image_io.h"

namespace fathom::cli {
namespace {

constexpr std::string_view kFilmEnding = ".film";

}  // namespace

OptionResult read_output(std::string_view text, Output& output) {
  output.path = text;
  output.format = output.standard() ? &runtime::kImageFormats.front() : runtime::image_format_of(output.path);
  if (output.format != nullptr || text.ends_with(kFilmEnding)) return std::nullopt;
  return OptionError{fmt::format("`{}` does not end in a picture format's name", text),
                     fmt::format("valid endings: {}, {}", runtime::image_endings(), kFilmEnding)};
}

OptionResult read_display_output(std::string_view text, Output& output) {
  output.path = text;
  output.format = output.standard() ? &runtime::kImageFormats.front() : runtime::image_format_of(output.path);
  if (output.format != nullptr && output.format->for_display) return std::nullopt;
  const char* problem = output.format ? "`{}`: this format holds numbers, not a picture to be shown"
                                      : "`{}` does not end in a picture format's name";
  return OptionError{fmt::format(fmt::runtime(problem), text), "valid endings: " + runtime::image_endings(true)};
}

OptionResult read_frame_output(std::string_view text, Output& output) {
  std::error_code ignored;
  if (!text.ends_with('/') && !std::filesystem::is_directory(text, ignored)) return read_output(text, output);
  output.path = text.ends_with('/') ? text : std::string(text) + '/';
  output.format = &runtime::kImageFormats.front();
  return std::nullopt;
}

OptionResult read_map_name(std::string_view text, std::string& path) {
  path = text;
  const runtime::ImageFormatInfo* format = runtime::image_format_of(path);
  if ((format && format->for_display) || runtime::is_float_map(path)) return std::nullopt;
  return OptionError{fmt::format("`{}` does not end in the name of a format for maps", text),
                     fmt::format("valid endings: {} for colours, .pfm for numbers", runtime::image_endings(true))};
}

std::string_view ending_of(const Output& output) {
  return output.film() ? kFilmEnding.substr(1) : output.format->ending;
}

void add_format_option(Arguments& arguments, bool display_only, int& format) {
  std::vector<std::string_view> names;  // displayable formats come first
  for (const runtime::ImageFormatInfo& known : runtime::kImageFormats) {
    if (known.for_display || !display_only) names.push_back(known.ending);
  }
  if (!display_only) names.push_back(kFilmEnding.substr(1));
  arguments.option("--format", "FORMAT", fmt::format("Format of `-o -`: {} (png)", fmt::join(names, ", ")),
                   one_of(names, format));
}

std::optional<ExitCode> apply_format(std::span<Output> outputs, int format, const Streams& streams) {
  const auto standard = [](const Output& output) { return output.standard(); };
  const auto streamed = std::count_if(outputs.begin(), outputs.end(), standard);
  if (streamed > 1) return fail(streams, kUsage, "`-o -` is given twice: standard output takes one picture");
  if (streamed == 1 && streams.out_terminal) {
    return fail(streams, kUsage, "`-o -`: standard output is a terminal, which shows no pictures",
                {"add `> out.png`, or `| PROGRAM`"});
  }
  if (format < 0) return std::nullopt;
  bool used = false;
  const auto index = static_cast<std::size_t>(format);
  for (Output& output : outputs) {
    if (!output.standard() && !output.folder()) continue;
    output.format = index < runtime::kImageFormats.size() ? &runtime::kImageFormats[index] : nullptr;
    used = true;
  }
  if (used) return std::nullopt;
  return fail(streams, kUsage, "--format is for `-o -`; a file's name says its format by its ending");
}

std::optional<std::string> write_to(const Output& output, const Fill& fill, const Streams& streams) {
  if (!output.standard()) {
    runtime::AtomicFile file(output.path);
    return fill(file);
  }
  std::vector<std::uint8_t> bytes;
  runtime::AtomicFile file("standard output", bytes);
  if (auto problem = fill(file)) return problem;
  streams.out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())).flush();
  if (streams.out) return std::nullopt;
  return "cannot write to standard output";
}

std::string wrote(const Output& output, int width, int height) {
  if (!output.standard()) return fmt::format("wrote {} ({}x{})", output.path, width, height);
  return fmt::format("wrote {} to standard output ({}x{})", output.film() ? "film" : output.format->ending, width,
                     height);
}

bool holds_whole(std::span<const Output> outputs) {
  return std::any_of(outputs.begin(), outputs.end(), [](const Output& o) { return o.standard() && o.layers(); });
}

std::vector<std::string> paths_of(std::span<const Output> outputs) {
  std::vector<std::string> paths;
  for (const Output& output : outputs) {
    if (!output.standard()) paths.push_back(output.path);
  }
  return paths;
}

Output default_output(const std::string& scene) {
  const std::string stem = scene == "-" ? "" : std::filesystem::path(scene).stem().string();
  return {(stem.empty() ? "out" : stem) + ".png", &runtime::kImageFormats.front()};
}

std::string with_suffix(const std::string& path, const std::string& suffix) {
  const std::size_t dot = path.rfind('.');
  return path.substr(0, dot) + "-" + suffix + path.substr(dot);
}

bool is_special(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

std::optional<std::string> check_text_path(const std::string& path) {
  return is_special(path) ? std::nullopt : runtime::check_file_path(path);
}

std::optional<std::string> write_text(const std::string& text, const std::string& path) {
  if (!is_special(path)) return runtime::write_file({text.begin(), text.end()}, path);
  std::ofstream file(path, std::ios::binary);
  file << text << std::flush;
  return file ? std::nullopt : std::optional(fmt::format("cannot write `{}`", path));
}

std::optional<ExitCode> check_text_output(std::optional<std::string>& output, const Streams& streams) {
  if (output == "-") output.reset();
  if (!output) return std::nullopt;
  if (const auto code = claim_outputs({*output}, streams)) return code;
  if (const auto problem = check_text_path(*output)) return fail(streams, kIo, *problem);
  return std::nullopt;
}

ExitCode write_text_output(const std::string& text, const std::optional<std::string>& output,
                           const Streams& streams) {
  if (!output) {
    streams.out << text;
    return kDone;
  }
  if (const auto problem = write_text(text, *output)) return fail(streams, kIo, *problem);
  say(streams, fmt::format("wrote {}", *output));
  return kDone;
}

std::optional<ExitCode> check_image_size(double width, double height, const compiler::Limits& limits,
                                         const Streams& streams) {
  const double side = std::max(width, height), pixels = width * height;
  if (side <= limits.image_side && pixels <= limits.pixels) return std::nullopt;
  const bool long_side = side > limits.image_side;
  return fail(streams, kUsage, fmt::format("a picture of {:.0f} by {:.0f} pixels is too large", width, height),
              {fmt::format("a side may have {:.0f} pixels, and the whole {:.0f} million", limits.image_side,
                           std::floor(limits.pixels / 1e6)),
               long_side ? compiler::raise(&compiler::Limits::image_side, side)
                         : compiler::raise(&compiler::Limits::pixels, pixels)});
}

std::optional<ExitCode> claim_outputs(const std::vector<std::string>& outputs, const Streams& streams) {
  for (const std::string& file : outputs) {
    if (!is_special(file)) streams.files.add_output(file);
  }
  return check_files(streams);
}

std::optional<ExitCode> check_files(const Streams& streams) {
  const auto& conflict = streams.files.conflict();
  if (!conflict) return std::nullopt;
  return fail(streams, kUsage, fmt::format("`{}` would be overwritten: it is read, or is another output", *conflict),
              {"give each output a name of its own"});
}

std::optional<ExitCode> check_output_files(const std::vector<std::string>& outputs, const Streams& streams) {
  if (const auto code = claim_outputs(outputs, streams)) return code;
  for (const std::string& path : outputs) {
    if (const auto problem = runtime::check_file_path(path)) return fail(streams, kIo, *problem);
  }
  return std::nullopt;
}

std::optional<ExitCode> check_outputs(std::span<const Output> outputs, const Streams& streams) {
  return check_output_files(paths_of(outputs), streams);
}

}  // namespace fathom::cli
