#include "runtime/cli/frames/scene_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/frontend/text/read_text.h"
#include "runtime/cli/input/text_file.h"

namespace fathom::cli {
namespace {

ExitCode fail_without_time(const SceneInput& input, const SceneArguments& arguments, const Streams& streams) {
  return fail(streams, kUsage,
              fmt::format("--frames: {} has neither a parameter `time` nor `frame`: its frames would be alike",
                          quoted(arguments.path)),
              {compiler::is_text_scene(input.source.text())
                   ? "declare it, param time = 0, and use it: .translate([sin(time), 0, 0])"
                   : "declare it, \"params\": {\"time\": 0}, and use it: \"translate\": [\"sin(time)\", 0, 0]",
               "`time` is in seconds, `frame` a whole number"});
}

}  // namespace

SceneArguments Sequence::at(const SceneArguments& arguments, int frame) const {
  SceneArguments result = arguments;
  const compiler::Definitions moment = compiler::moment(animation, frame, time_of(frame));
  result.definitions.insert(result.definitions.end(), moment.begin(), moment.end());
  return result;
}

std::string Sequence::describe(int frame) const { return fmt::format("frame {} ({:.4g} s)", frame, time_of(frame)); }

std::variant<Sequence, ExitCode> sequence_of(const FrameOptions& options, SceneInput& input,
                                             const SceneArguments& arguments, const Streams& streams) {
  const auto read = read_animation(input, arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  const auto& animation = std::get<compiler::Animation>(read);
  if (!animation.time && !animation.frame) return fail_without_time(input, arguments, streams);
  for (const auto& set : compiler::moment(animation, 0, 0)) {
    const auto same = [&](const auto& given) { return given.first == set.first; };
    if (std::none_of(arguments.definitions.begin(), arguments.definitions.end(), same)) continue;
    return fail(streams, kUsage, fmt::format("-D {} does not go with --frames, which sets it for each frame", set.first),
                {"leave out one of them"});
  }
  if (options.all && !animation.frames) {
    return fail(streams, kUsage,
                fmt::format("--frames all: {} does not say how many there are", quoted(arguments.path)),
                {"write which, as --frames 0:48, or give the scene's `film` the property `frames`"});
  }
  const FrameRange frames = options.all ? FrameRange{0, *animation.frames, 1} : *options.range;
  return Sequence{animation, frames, options.fps.value_or(animation.fps)};
}

}  // namespace fathom::cli
