#include "runtime/cli/standard_output.h"

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
  const LongRender& asked = request.long_render;
  if (!asked.checkpoint && (asked.resume || asked.interval)) {
    return fail(streams, kUsage, "with `-o -` alone the checkpoint has no name", {"name it with --checkpoint FILE"});
  }
  return std::nullopt;
}

}  // namespace fathom::cli
