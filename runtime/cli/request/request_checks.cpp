#include "runtime/cli/request/request_checks.h"

#include <fmt/format.h>

#include <algorithm>

namespace fathom::cli {

std::optional<ExitCode> check_standard_output(const RenderRequest& request, const Streams& streams) {
  const auto standard = [](const Output& output) { return output.standard(); };
  if (std::none_of(request.outputs.begin(), request.outputs.end(), standard)) return std::nullopt;
  if (request.stats_json == "-") {
    return fail(streams, kUsage, "`-o -` and `--stats-json -` both write to standard output",
                {"name a file for one of them"});
  }
  if (request.watch) {
    return fail(streams, kUsage, "--watch does not go with `-o -`: standard output takes one picture",
                {"name a file with -o"});
  }
  if (default_checkpoint(request)) return std::nullopt;
  if (request.albedo || request.depth || request.normal) {
    return fail(streams, kUsage, "--albedo, --depth and --normal write files beside a picture's, and `-o -` has none",
                {"add -o FILE, or use `--format exr`, which holds all layers"});
  }
  if (!request.checkpoint && (request.resume || request.checkpoint_interval)) {
    return fail(streams, kUsage, "with `-o -` alone the checkpoint has no name", {"name it with --checkpoint FILE"});
  }
  return std::nullopt;
}

std::optional<ExitCode> check_frames(const RenderRequest& request, const Streams& streams) {
  const auto folder = std::find_if(request.outputs.begin(), request.outputs.end(),
                                   [](const Output& output) { return output.folder(); });
  if (!request.frames.given()) {
    if (request.frames.fixed_noise) return fail(streams, kUsage, "--fixed-noise is for --frames, which is not given");
    if (folder == request.outputs.end()) return std::nullopt;
    return fail(streams, kUsage, fmt::format("`{}` is a folder: a picture needs a name", folder->path),
                {fmt::format("write -o {}out.png, or add --frames for pictures named by number", folder->path)});
  }
  const auto refuse = [&](std::string_view what, std::string_view remedy) {
    return fail(streams, kUsage, fmt::format("{} does not go with --frames", what), {std::string(remedy)});
  };
  if (request.watch) return refuse("--watch", "watch a moment of it: -D time=1.5 --watch");
  if (std::any_of(request.outputs.begin(), request.outputs.end(), [](const Output& o) { return o.standard(); })) {
    return refuse("`-o -`, which takes one picture,", "name the files, as -o out.png for out-0000.png and on");
  }
  if (request.stats_json == "-") return refuse("`--stats-json -`", "name the files, as --stats-json stats.json");
  return std::nullopt;
}

}  // namespace fathom::cli
