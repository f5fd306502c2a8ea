#include "runtime/cli/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <ostream>

#include "runtime/render.h"

namespace fathom::cli {
namespace {

// Writing may take no more than this share of the time: threads that finish a unit wait for it.
constexpr double kMostShare = 0.05;

std::string text_of(runtime::PixelRect area) {
  return fmt::format("{},{},{},{}", area.x0, area.y0, area.x1, area.y1);
}

// What a resumed render must agree in beside what films that are merged must.
runtime::Identity with_part(runtime::Identity identity, runtime::PixelRect area, runtime::SampleRange samples) {
  identity.emplace_back("crop", text_of(area));
  identity.emplace_back("sample range", fmt::format("{}:{}", samples.first, samples.last));
  return identity;
}

bool exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

}  // namespace

std::optional<ExitCode> Checkpoint::resume(const runtime::FilmHeader& header, const runtime::Settings& settings,
                                           runtime::RenderOptions& options, const Streams& streams) {
  if (!exists(path_)) {
    note(streams, fmt::format("there is no checkpoint `{}`: the render begins at its beginning", path_));
    return std::nullopt;
  }
  auto read = runtime::read_film(path_);
  if (const auto* unread = std::get_if<runtime::UnreadFilm>(&read)) {
    return fail(streams, unread->missing ? kIo : kBadScene, unread->problem,
                {"without --resume the render begins at its beginning"});
  }
  auto& file = std::get<runtime::FilmFile>(read);
  const auto problems = runtime::differences(with_part(file.header.identity, file.shape.area, file.header.samples),
                                             with_part(header.identity, settings.crop, header.samples));
  if (!problems.empty()) {
    return fail(streams, kBadScene, fmt::format("`{}` is the checkpoint of another render", path_), problems);
  }
  if (!runtime::can_resume(file.render, settings)) {
    return fail(streams, kBadScene, fmt::format("`{}` makes no sense: its sums are not what its head says", path_));
  }
  options.resume_from = std::make_shared<runtime::PartialRender>(std::move(file.render));
  ours_ = true;
  return std::nullopt;
}

std::optional<ExitCode> Checkpoint::begin_afresh(const Streams& streams) {
  if (!exists(path_)) return std::nullopt;
  const auto read = runtime::read_film_header(path_);
  if (const auto* unread = std::get_if<runtime::UnreadFilm>(&read)) {
    return fail(streams, unread->missing ? kIo : kBadScene, unread->problem,
                {"--checkpoint FILE chooses another name for the checkpoint"});
  }
  note(streams, fmt::format("`{}` is there from an earlier render and will be replaced by this one's; stop now and "
                            "add --resume to go on from it",
                            path_));
  return std::nullopt;
}

std::optional<ExitCode> Checkpoint::check_path(const Streams& streams) const {
  if (const auto problem = runtime::check_file_path(path_)) return fail(streams, kIo, *problem);
  return std::nullopt;
}

void Checkpoint::tick(const runtime::FilmHeader& header, const runtime::RenderOptions::Look& look, double seconds,
                      const Streams& streams) {
  if (due_ == 0) due_ = seconds + interval_;
  if (seconds < due_) return;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  runtime::AtomicFile file(path_);
  look([&](const runtime::PartialRender& render) { runtime::write_film(header, render, file); });
  commit(file, streams);
  const double took = std::chrono::duration<double>(Clock::now() - start).count();
  due_ = seconds + took + std::max(interval_, took / kMostShare);
}

bool Checkpoint::write(const runtime::FilmHeader& header, const runtime::PartialRender& render,
                       const Streams& streams) {
  runtime::AtomicFile file(path_);
  runtime::write_film(header, render, file);
  return commit(file, streams);
}

bool Checkpoint::commit(runtime::AtomicFile& file, const Streams& streams) {
  const std::optional<std::string> problem = file.commit();
  failed_ = problem.has_value();
  if (!failed_) {
    ours_ = true;
    ++written_;
  } else if (!warned_) {
    warned_ = true;
    streams.err << fmt::format("warning: no checkpoint: {}\n", *problem) << std::flush;
  }
  return !failed_;
}

void Checkpoint::remove() {
  std::error_code ignored;
  if (ours_) std::filesystem::remove(path_, ignored);
  ours_ = false;
}

}  // namespace fathom::cli
