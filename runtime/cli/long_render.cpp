#include "runtime/cli/long_render.h"

#include <fmt/format.h>

#include "runtime/cli/checkpoint.h"
#include "runtime/cli/values.h"

namespace fathom::cli {
namespace {

Verdict read_sample_range(std::string_view text, runtime::SampleRange& range) {
  const std::size_t middle = text.find(':');
  const auto wrong = [&] {
    return Complaint{fmt::format("`{}` is not a range of samples", text),
                     "write it as 0:32: the samples from the first number up to the second, which is not in it"};
  };
  if (middle == std::string_view::npos) return wrong();
  std::int64_t first = 0, last = 0;
  if (read_whole(text.substr(0, middle), 0, compiler::kMaxSpp, first)) return wrong();
  if (read_whole(text.substr(middle + 1), 1, compiler::kMaxSpp, last) || first >= last) return wrong();
  range = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
  return std::nullopt;
}

}  // namespace

void add_long_render_options(Arguments& arguments, LongRender& request) {
  arguments.group("Long renders (docs/RENDERING.md)");
  arguments.option("--checkpoint", "FILE",
                   "Where what is done is kept, now and then and when a signal ends the render (the first output's "
                   "name with .checkpoint, removed when the pictures are written; FILE stays)",
                   any_text(request.checkpoint));
  arguments.option("--checkpoint-interval", "TIME", "How often: 30s, 5m, 1h (60s)",
                   into(read_duration, request.interval));
  arguments.flag("--resume", "Go on from the checkpoint: the same bits as without the interruption", request.resume);
  arguments.option("--time-limit", "TIME", "Stop after so long and write the picture so far: 30s, 10m, 1.5h",
                   into(read_duration, request.time_limit));
  arguments.option("--sample-range", "A:B",
                   "Only samples A to B-1 of the --spp ones of each pixel: parts for `fathom merge`",
                   into(read_sample_range, request.sample_range));
}

std::optional<ExitCode> apply(const LongRender& request, const compiler::CompiledScene& scene,
                              runtime::RenderOptions& options, const Streams& streams) {
  options.time_limit = request.time_limit;
  if (!request.sample_range) return std::nullopt;
  const int spp = options.spp.value_or(scene.settings.spp);
  if (request.sample_range->last > static_cast<std::uint32_t>(spp)) {
    return fail(streams, kUsage,
                fmt::format("--sample-range: {} is beyond the {}", request.sample_range->last,
                            count_of(static_cast<std::size_t>(spp), "sample") + " of a pixel"),
                {"--spp says how many there are in all parts together"});
  }
  if (options.adaptive.value_or(scene.settings.adaptive)) {
    return fail(streams, kUsage, "--sample-range: with adaptive sampling a pixel's samples depend on all others",
                {"add --no-adaptive, or render all samples"});
  }
  options.sample_range = request.sample_range;
  return std::nullopt;
}

}  // namespace fathom::cli
