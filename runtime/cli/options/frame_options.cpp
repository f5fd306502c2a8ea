#include "runtime/cli/options/frame_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/scene/compiled_scene.h"
#include "runtime/cli/options/values.h"

namespace fathom::cli {
namespace {

constexpr std::size_t kUsualDigits = 4;

OptionResult read_frames(std::string_view text, FrameOptions& options) {
  options.all = text == "all";
  options.range.reset();
  if (options.all) return std::nullopt;
  const auto wrong = [&] {
    return OptionError{fmt::format("`{}` are no frames", text),
                       "write 7, 0:48 or 0:48:2, the second number not among them and the third the step; or all"};
  };
  std::int64_t parts[3] = {0, 0, 1};
  std::size_t count = 0;
  for (std::string_view rest = text;; ++count) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (count == 3 || read_whole(rest.substr(0, end), count == 2, compiler::kMaxFrames, parts[count])) return wrong();
    if (end == rest.size()) break;
    rest.remove_prefix(end + 1);
  }
  if (count == 0) parts[1] = parts[0] + 1;
  if (parts[0] >= parts[1]) return wrong();
  options.range = {static_cast<int>(parts[0]), static_cast<int>(parts[1]), static_cast<int>(parts[2])};
  return std::nullopt;
}

// Reads frames per second: "24", "23.976" or "30000/1001".
OptionResult read_fps(std::string_view text, double& fps) {
  const std::size_t over = text.find('/');
  const std::optional<double> number = to_number(text.substr(0, over));
  const std::optional<double> divisor = over == text.npos ? 1 : to_number(text.substr(over + 1));
  const double value = number && divisor ? *number / *divisor : 0;
  if (!(value >= compiler::kMinFps && value <= compiler::kMaxFps)) {
    return OptionError{fmt::format("`{}` is not a number from {} to {}", text, compiler::kMinFps, compiler::kMaxFps),
                       "frames a second, as 24, 23.976 or 30000/1001"};
  }
  fps = value;
  return std::nullopt;
}

}  // namespace

void add_frames_option(Arguments& arguments, const std::string& doc, FrameOptions& options) {
  arguments.option("--frames", "A:B[:S]", doc,
                   [&options](std::string_view text) { return read_frames(text, options); });
}

void add_frame_options(Arguments& arguments, FrameOptions& options) {
  add_frames_option(arguments,
                    "Frames A to B-1, every S-th; 7 is one frame, all what the scene's film says: sets the scene's "
                    "parameter `time`, in seconds, or `frame`",
                    options);
  arguments.option("--fps", "N", "Frames per second, as 25 or 30000/1001 (the scene's, 24)",
                   into(read_fps, options.fps));
}

void add_motion_options(Arguments& arguments, FrameOptions& options) {
  arguments.group("Animation (docs/how-to/animate.md)");
  add_frame_options(arguments, options);
  arguments.flag("--fixed-noise", "Use the same random numbers for all frames: their noise stands still",
                 options.fixed_noise);
  arguments.option("--shutter-times", "K",
                   "Moments that a camera's shutter sees, at most half of --spp (16); more for fast motion",
                   whole(options.shutter_times, 1, compiler::kMaxSpp));
}

std::string numbered(const std::string& path, int frame) {
  const std::size_t name = path.rfind('/') + 1;  // 0 without a folder
  std::size_t begin = path.rfind('#');
  if (begin != path.npos && begin >= name) {
    const std::size_t end = begin + 1;
    while (begin > name && path[begin - 1] == '#') --begin;
    return fmt::format("{}{:0{}}{}", path.substr(0, begin), frame, end - begin, path.substr(end));
  }
  std::size_t dot = path.rfind('.');
  if (dot == path.npos || dot <= name) dot = path.size();
  return fmt::format("{}{}{:0{}}{}", path.substr(0, dot), dot > name ? "-" : "", frame, kUsualDigits,
                     path.substr(dot));
}

}  // namespace fathom::cli
