#include "runtime/cli/options/long_render.h"

#include <fmt/format.h>

#include "runtime/cli/options/values.h"

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

Verdict read_file_name(std::string_view text, std::string& name) {
  if (text.empty()) return Complaint{"the file's name is empty", "name it, as now.film"};
  name = text;
  return std::nullopt;
}

}  // namespace

void add_interval_option(Arguments& arguments, LongRender& request) {
  arguments.option("--checkpoint-interval", "TIME",
                   "Time between checkpoints, as 30s, 5m or 1h (60s; of units of a plan 10m)",
                   into(read_duration, request.interval));
}

void add_long_render_options(Arguments& arguments, LongRender& request) {
  arguments.group("Long renders (docs/how-to/render.md)");
  arguments.option("--checkpoint", "FILE",
                   "File that keeps the samples so far, written at intervals and when a signal or --time-limit ends "
                   "the render (the first output's name with .checkpoint, which goes when the render is done)",
                   into(read_file_name, request.checkpoint));
  add_interval_option(arguments, request);
  arguments.flag("--resume",
                 "Continue from the checkpoint; the picture has the same bits as without the interruption",
                 request.resume);
  arguments.option("--time-limit", "TIME",
                   "End the render after this time, as 30s, 10m or 1.5h, and write the picture so far",
                   into(read_duration, request.time_limit));
  arguments.option("--sample-range", "A:B",
                   "Take only samples A to B-1 of each pixel's --spp: a part for `fathom merge`",
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
  options.sample_range = request.sample_range;
  return std::nullopt;
}

}  // namespace fathom::cli
