#include "runtime/cli/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "compiler/compiled_scene.h"
#include "runtime/atomic_file.h"
#include "runtime/image_io.h"

namespace fathom::cli {
namespace {

constexpr std::string_view kFilmEnding = ".film";

// One name for a file however it is written, whether it exists or not.
std::filesystem::path canonical_name(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
}

}  // namespace

Verdict read_output(std::string_view text, std::string& path) {
  path = text;
  if (runtime::image_format_of(path) || is_film(path)) return std::nullopt;
  return Complaint{fmt::format("`{}` does not end in a picture format's name", text),
                   fmt::format("valid endings: {}, {}", runtime::image_endings(), kFilmEnding)};
}

Verdict read_shown_output(std::string_view text, std::string& path) {
  path = text;
  const runtime::ImageFormatInfo* format = runtime::image_format_of(path);
  if (format && format->shown) return std::nullopt;
  const char* problem = format ? "`{}`: this format holds numbers, not a picture to be shown"
                               : "`{}` does not end in a picture format's name";
  return Complaint{fmt::format(fmt::runtime(problem), text), "valid endings: " + runtime::image_endings(true)};
}

bool is_film(const std::string& path) { return path.ends_with(kFilmEnding); }

bool holds_layers(const std::string& output) {
  const runtime::ImageFormatInfo* format = runtime::image_format_of(output);
  return is_film(output) || (format != nullptr && format->format == runtime::ImageFormat::Exr);
}

std::string default_output(const std::string& scene) {
  const std::string stem = scene == "-" ? "" : std::filesystem::path(scene).stem().string();
  return (stem.empty() ? "out" : stem) + ".png";
}

std::string beside(const std::string& path, const std::string& suffix) {
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

std::optional<ExitCode> check_picture_size(double width, double height, const compiler::Limits& limits,
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

std::optional<ExitCode> check_collisions(const std::string& scene, const std::vector<std::string>& outputs,
                                         const Streams& streams) {
  std::vector<std::filesystem::path> taken;
  if (scene != "-") taken.push_back(canonical_name(scene));
  for (const std::string& file : outputs) {
    std::filesystem::path path = canonical_name(file);
    if (std::find(taken.begin(), taken.end(), path) != taken.end()) {
      return fail(streams, kUsage, fmt::format("`{}` would be overwritten: it is read, or is another output", file),
                  {"give each output a name of its own"});
    }
    taken.push_back(std::move(path));
  }
  return std::nullopt;
}

}  // namespace fathom::cli
