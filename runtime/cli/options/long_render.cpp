#include "runtime/cli/options/long_render.h"

#include <fmt/format.h>

#include "runtime/cli/options/values.h"
#include "runtime/film/noise.h"

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

bool is_adaptive(const compiler::CompiledScene& scene, const runtime::RenderOptions& options) {
  return options.adaptive.value_or(scene.settings.adaptive);
}

std::optional<ExitCode> apply_noise(const LongRender& request, const compiler::CompiledScene& scene,
                                    runtime::RenderOptions& options, const Streams& streams) {
  if (request.min_spp && !request.noise) {
    return fail(streams, kUsage, "--min-spp is for --noise, which is not given");
  }
  if (!request.noise) return std::nullopt;
  const int spp = options.spp.value_or(scene.settings.spp);
  const int least = request.min_spp.value_or(runtime::kLeastNoiseSpp);
  if (spp / 2 * 2 < least) {
    return fail(
        streams, kUsage,
        fmt::format("--noise: {} of a pixel are too few", count_of(static_cast<std::size_t>(spp), "sample")),
        {fmt::format("ask for --spp {} or more: it is the most that a pixel may get, by twos", (least + 1) / 2 * 2)});
  }
  if (is_adaptive(scene, options)) {
    return fail(streams, kUsage, "--noise does not go with adaptive sampling: both share samples out",
                {"add --no-adaptive, or leave out --noise"});
  }
  if (request.sample_range) {
    return fail(streams, kUsage, "--noise does not go with --sample-range: how many samples there are is not known");
  }
  options.noise = request.noise;
  options.min_spp = request.min_spp;
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
  arguments.option(
      "--noise", "LIMIT",
      "Stop sampling a tile once its noise is below LIMIT, as 0.02; --spp is the max per pixel, rounded down to even",
      into(read_positive, request.noise));
  arguments.option("--min-spp", "N", "Min samples per pixel before --noise may stop a tile (16)",
                   whole(request.min_spp, runtime::kLeastNoiseSpp, compiler::kMaxSpp));
  arguments.option("--sample-range", "A:B",
                   "Take only samples A to B-1 of each pixel's --spp: a part for `fathom merge`",
                   into(read_sample_range, request.sample_range));
}

std::optional<ExitCode> apply(const LongRender& request, const compiler::CompiledScene& scene,
                              runtime::RenderOptions& options, const Streams& streams) {
  options.time_limit = request.time_limit;
  if (const auto code = apply_noise(request, scene, options, streams)) return code;
  if (!request.sample_range) return std::nullopt;
  const int spp = options.spp.value_or(scene.settings.spp);
  if (request.sample_range->last > static_cast<std::uint32_t>(spp)) {
    return fail(streams, kUsage,
                fmt::format("--sample-range: {} is beyond the {}", request.sample_range->last,
                            count_of(static_cast<std::size_t>(spp), "sample") + " of a pixel"),
                {"--spp says how many there are in all parts together"});
  }
  if (is_adaptive(scene, options)) {
    return fail(streams, kUsage, "--sample-range: with adaptive sampling a pixel's samples depend on all others",
                {"add --no-adaptive, or render all samples"});
  }
  options.sample_range = request.sample_range;
  return std::nullopt;
}

}  // namespace fathom::cli
