#include "runtime/cli/picture/render_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <ostream>

#include "runtime/cli/input/memory.h"
#include "runtime/cli/options/version.h"
#include "runtime/cli/picture/closing_lines.h"
#include "runtime/cli/picture/cost_map.h"
#include "runtime/cli/picture/image_warning.h"
#include "runtime/cli/picture/invalid_rays.h"
#include "runtime/cli/picture/render_identity.h"
#include "runtime/denoise/denoise.h"

namespace fathom::cli {
namespace {

// Writes the name of the scene, what was rendered of it by which version, and the counts and times.
std::optional<std::string> write_stats(const std::string& path, const std::string& scene,
                                       const runtime::FilmHeader& header, const runtime::Stats& stats,
                                       const Streams& streams) {
  nlohmann::ordered_json json = {{"scene", scene}, {"commit", kCommit}};
  for (const auto& [name, value] : header.identity) json["render"][name] = value;
  json["width"] = header.width, json["height"] = header.height;
  json["samples"] = {header.samples.first, header.samples.last};
  json.update(nlohmann::ordered_json::parse(runtime::to_json(stats)));
  const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
  if (path == "-") {
    streams.out << text;
    return std::nullopt;
  }
  return write_text(text, path);
}

// Returns the prefix of lines about one frame or unit of several.
std::string frame_text(const RenderRequest& request) {
  if (request.unit) return fmt::format("unit {}: ", *request.unit);
  if (!request.frame) return "";
  return fmt::format("frame {}, {} of {}: ", request.frame->number, request.frame->index + 1, request.frame->count);
}

constexpr const char* kNoPictureYet = "no picture is written: no pixel has a sample yet";

// Returns "a pixel has 3 samples at least, 5.20 on average, 8 at most".
std::string samples_in(const runtime::Film& film) {
  std::uint32_t least = ~0u, most = 0;
  const runtime::PixelRect area = film.area();
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      least = std::min(least, film.samples(x, y));
      most = std::max(most, film.samples(x, y));
    }
  }
  return fmt::format("a pixel has {} at least, {:.2f} on average, {} at most", count_of(least, "sample"),
                     static_cast<double>(film.samples()) / static_cast<double>(area.pixels()), most);
}

}  // namespace

ImageFiles image_files_of(const RenderRequest& request) {
  return {request.outputs, request.albedo, request.depth, request.normal, request.denoise, request.bits != 0};
}

std::optional<Checkpoint> checkpoint_of(const RenderRequest& request) {
  if (request.watch) return std::nullopt;
  const auto path = request.checkpoint ? request.checkpoint : default_checkpoint(request);
  if (!path) return std::nullopt;
  return std::optional<Checkpoint>(std::in_place, *path, request.checkpoint.has_value(),
                                   request.checkpoint_interval.value_or(kCheckpointInterval),
                                   read_limits(request.scene.limits));
}

RenderJob::RenderJob(PreparedRender& picture, const Streams& streams, WatchState* watching,
                     std::optional<Interruption>& interruption)
    : request_(picture.request),
      scene_(picture.scene),
      streams_(streams),
      watching_(watching),
      interruption_(interruption),
      header_(film_header(scene_, runtime::resolve(scene_, request_.options), request_.options,
                          request_.frame ? std::optional(request_.frame->number) : std::nullopt)),
      checkpoint_(checkpoint_of(request_)),
      line_(streams, frame_text(request_)) {}

ExitCode RenderJob::run() {
  if (const auto code = begin()) return *code;
  // Under --watch a stop signal ends the program at once.
  if (!watching_ && !interruption_) interruption_.emplace();
  if (interruption_) interruption_->end_preparation();
  runtime::RenderResult result = render();
  line_.erase();
  if (watching_ && result.stats.end == runtime::RenderEnd::Cancelled) return kDone;
  const ExitCode code = end(result);
  using End = runtime::RenderEnd;
  complete_ = code == kDone && (result.stats.end == End::Done || result.stats.end == End::Noise);
  stats_ = result.stats;
  return code;
}

std::optional<ExitCode> RenderJob::begin() {
  if (!checkpoint_) return std::nullopt;
  if (request_.resume)
    return checkpoint_->resume(header_, runtime::resolve(scene_, request_.options), request_.options, streams_,
                               request_.frame || request_.unit);
  return checkpoint_->start_new(header_, runtime::resolve(scene_, request_.options), streams_);
}

// Only the thread that calls on_tick prints during the render.
runtime::RenderResult RenderJob::render() {
  runtime::RenderOptions options = request_.options;
  options.cancel = watching_ ? &watching_->changed : &interruption_->stop();
  std::mutex mutex;
  std::optional<runtime::Progress> latest;
  options.on_progress = [&](const runtime::Progress& progress) {
    const std::lock_guard lock(mutex);
    latest = progress;
  };
  const auto start = std::chrono::steady_clock::now();
  options.on_tick = [&](const runtime::RenderOptions::SnapshotReader& snapshot) {
    std::optional<runtime::Progress> progress;
    {
      const std::lock_guard lock(mutex);
      progress = latest;
    }
    if (progress && !request_.quiet) line_.update(*progress);
    if (watching_ && watching_->files.changed()) watching_->changed = true;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (checkpoint_) checkpoint_->tick(header_, snapshot, seconds, streams_);
    if (interruption_ && interruption_->image_requested()) write_so_far(snapshot);
  };
  return runtime::render(scene_, options);
}

// Handles SIGUSR1. A failed write is only a warning, because the render goes on. Render threads wait while the images
// are written, but not for the denoiser.
void RenderJob::write_so_far(const runtime::RenderOptions::SnapshotReader& snapshot) {
  std::optional<std::string> problem;
  std::vector<std::string> lines;
  runtime::PartialRender copy;
  ImageFiles pictures = image_files_of(request_);
  std::erase_if(pictures.outputs, [](const Output& output) { return output.standard(); });
  if (pictures.outputs.empty()) return warn(streams_, "standard output gets its picture when the render ends");
  const auto write = [&](const runtime::PartialRender& render) {
    problem = write_image_files(pictures, header_, render, std::nullopt, lines, streams_);
  };
  snapshot([&](const runtime::PartialRender& render) {
    if (render.film.samples() == 0) {
      problem = kNoPictureYet;
    } else if (request_.denoise) {
      copy = render;
    } else {
      write(render);
    }
  });
  if (request_.denoise && !problem) {
    runtime::denoise(copy.film, 1);
    write(copy);
  }
  line_.erase();
  if (problem) warn(streams_, *problem);
  for (const std::string& line : lines) note(streams_, line + ", so far");
  streams_.err.flush();
}

// Writes the checkpoint before the images, because the images can be made from the checkpoint.
ExitCode RenderJob::end(runtime::RenderResult& result) {
  using End = runtime::RenderEnd;
  const End ended = result.stats.end;
  warn_of_overflow(result.stats);
  warn_of_invalid(result.stats);
  warn_of_image(result);
  const bool undone = ended == End::Cancelled || ended == End::TimeLimit;
  const bool keep = checkpoint_ && (undone || checkpoint_->named());
  if (keep) checkpoint_->write(header_, result, streams_);
  if (checkpoint_) result.stats.checkpoints = static_cast<std::uint64_t>(checkpoint_->written());
  // An image without samples would replace a file that may be good. The film of an incomplete unit must not look
  // complete.
  const bool pictures = !undone || (!request_.unit && result.film.samples() > 0);
  if (request_.denoise && pictures) runtime::denoise(result.film, result.settings.threads);
  if (const auto problem = write_all(result, pictures)) return fail_to_write(*problem, result, keep);
  if (!pictures && !request_.unit) note(streams_, kNoPictureYet);
  if (ended == End::Noise && !request_.quiet) {
    note(streams_, "the noise is below the threshold: " + samples_in(result.film));
  }
  if (undone) return end_undone(result);
  if (checkpoint_ && !checkpoint_->named()) checkpoint_->remove(streams_);
  return keep && checkpoint_->problem() ? fail_checkpoint() : kDone;
}

ExitCode RenderJob::end_undone(const runtime::RenderResult& result) {
  const bool limit = result.stats.end == runtime::RenderEnd::TimeLimit;
  note(streams_, (limit ? "the time limit ended the render: " : "interrupted: ") + samples_in(result.film));
  if (checkpoint_ && checkpoint_->problem()) return fail_checkpoint();
  if (checkpoint_) note(streams_, fmt::format("what is done is in {}; --resume goes on", checkpoint_->path()));
  if (!checkpoint_ && !watching_) note(streams_, "what is done is not kept: --checkpoint FILE would keep it");
  return limit ? kDone : kInterrupted;
}

ExitCode RenderJob::fail_checkpoint() {
  Help help;
  if (checkpoint_->holds_state()) help.push_back(earlier_state());
  return fail(streams_, kIo, fmt::format("what was rendered is not kept: {}", *checkpoint_->problem()), help);
}

std::string RenderJob::earlier_state() const {
  return fmt::format("an earlier state of it is in {}; --resume goes on from that", checkpoint_->path());
}

// Warns of rays that were lost because the field is NaN.
void RenderJob::warn_of_invalid(const runtime::Stats& stats) {
  const std::optional<glm::dvec3>& at = stats.march.invalid_at;
  if (at) warn(streams_, invalid_text(scene_, stats.march.invalid, stats.march.rays, *at));
}

// Warns of an image that shows nothing. Applies only to whole images with all their samples, since parts may well be
// empty.
void RenderJob::warn_of_image(const runtime::RenderResult& result) {
  using End = runtime::RenderEnd;
  const runtime::Settings& used = result.settings;
  const bool whole = !request_.crop && used.samples.size() == static_cast<std::uint32_t>(used.spp);
  if (!whole || (result.stats.end != End::Done && result.stats.end != End::Noise)) return;
  if (const auto text = image_warning(scene_, result)) warn(streams_, *text);
}

void RenderJob::warn_of_overflow(const runtime::Stats& stats) {
  if (stats.saturated > 0) warn(streams_, overflow_text(count_of(stats.saturated, "sample")));
  // If most lit samples are brighter, light this faint is black in every image anyway.
  if (stats.faint_samples == 0 || 2 * stats.faint_samples < stats.lit_samples) return;
  warn(streams_, fmt::format("{} of {} with light are too faint for the film, which counts in steps of {:.2g}: "
                             "coarse or black; scale the lights up, and --exposure down",
                             stats.faint_samples, count_of(stats.lit_samples, "sample"), runtime::kFilmStep));
}

// Writes all files, or all except the images, and prints the closing lines. The peak memory in them includes writing.
std::optional<std::string> RenderJob::write_all(runtime::RenderResult& result, bool pictures) {
  std::vector<std::string> lines;
  std::optional<double> seconds;
  std::optional<std::string> problem;
  if (request_.options.profile) seconds = result.stats.seconds;
  if (pictures) problem = write_image_files(image_files_of(request_), header_, result, seconds, lines, streams_);
  if (pictures && request_.cost_map && !problem) problem = write_cost_maps(*request_.cost_map, result.film, lines);
  result.stats.peak_memory = runtime::peak_memory();
  if (request_.stats_json && !problem) {
    problem = write_stats(*request_.stats_json, scene_.source.name(), header_, result.stats, streams_);
  }
  if (!request_.quiet) print_closing(result, lines);
  return problem;
}

void RenderJob::print_closing(const runtime::RenderResult& result, const std::vector<std::string>& lines) {
  std::ostream& err = streams_.err;
  const bool all = request_.verbosity > 0 || request_.options.profile;
  if (all) err << runtime::to_table(result.stats);
  if ((watching_ || request_.frame || request_.unit) && !all) {
    err << frame_text(request_) << closing_line(scene_.source.name(), result, lines);
    return;
  }
  err << closing_lines(scene_.source.name(), result);
  for (const std::string& line : lines) err << line << '\n';
}

// Reports a write error. The samples are not lost with the image if the checkpoint holds them.
ExitCode RenderJob::fail_to_write(const std::string& problem, const runtime::RenderResult& result, bool kept) {
  Help help;
  if (checkpoint_ && (kept ? !checkpoint_->problem() : checkpoint_->write(header_, result, streams_))) {
    help.push_back(fmt::format("what was rendered is in {}; --resume writes the pictures", checkpoint_->path()));
  } else if (checkpoint_ && checkpoint_->holds_state()) {
    help.push_back(earlier_state());
  }
  return fail(streams_, kIo, problem, help);
}

}  // namespace fathom::cli
