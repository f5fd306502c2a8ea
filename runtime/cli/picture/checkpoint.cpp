#include "runtime/cli/picture/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <ostream>

#include "runtime/render.h"

namespace fathom::cli {
namespace {

// Maximum fraction of the time spent on writing, because threads that finish a unit wait for the write.
constexpr double kMaxShare = 0.05;

std::string text_of(runtime::PixelRect area) {
  return fmt::format("{},{},{},{}", area.x0, area.y0, area.x1, area.y1);
}

// Extends an identity by the facts that a resumed render must match but merged films need not: crop and sample range.
runtime::Identity with_part(runtime::Identity identity, runtime::PixelRect area, runtime::SampleRange samples) {
  identity.emplace_back("crop", text_of(area));
  identity.emplace_back("sample range", fmt::format("{}:{}", samples.first, samples.last));
  return identity;
}

// Lists the differences between the checkpoint's render and this render.
std::vector<std::string> differences(const runtime::FilmFile& file, const runtime::FilmHeader& header,
                                     const runtime::Settings& settings) {
  return runtime::differences(with_part(file.header.identity, file.shape.area, file.header.samples),
                              with_part(header.identity, settings.crop, header.samples));
}

constexpr const char* kElsewhere = "--checkpoint FILE chooses another name for the checkpoint";
constexpr const char* kWillBeReplaced = "`{}` is there from another render and will be replaced by this one's";
constexpr const char* kNoSense = "`{}` makes no sense: its sums are not what its head says";

}  // namespace

std::string Checkpoint::remedy() const {
  return fmt::format("remove `{}` to begin at the beginning, or name another file with --checkpoint FILE", path_);
}

std::optional<ExitCode> Checkpoint::resume(const runtime::FilmHeader& header, const runtime::Settings& settings,
                                           runtime::RenderOptions& options, const Streams& streams,
                                           bool one_of_many) {
  known_ = runtime::stamp_of(path_);
  if (!known_) {
    if (!one_of_many)
      note(streams, fmt::format("there is no checkpoint `{}`: the render begins at its beginning", path_));
    return std::nullopt;
  }
  auto read = runtime::read_film(path_, limits_);
  if (const auto* read_error = std::get_if<runtime::FilmReadError>(&read)) {
    return fail(streams, read_error->missing ? kIo : kBadScene, read_error->problem,
                {read_error->not_a_film ? kElsewhere : remedy()});
  }
  auto& file = std::get<runtime::FilmFile>(read);
  std::vector<std::string> problems = differences(file, header, settings);
  if (!problems.empty() && one_of_many && !named_) {
    note(streams, fmt::format(kWillBeReplaced, path_));
    return std::nullopt;
  }
  if (!problems.empty()) {
    problems.push_back("render with the settings that are there, or " + remedy());
    return fail(streams, kBadScene, fmt::format("`{}` is the checkpoint of another render", path_), problems);
  }
  if (!runtime::can_resume(file.render, settings)) {
    return fail(streams, kBadScene, fmt::format(kNoSense, path_), {remedy()});
  }
  options.resume_from = std::make_shared<runtime::PartialRender>(std::move(file.render));
  is_own_ = true;
  return std::nullopt;
}

std::optional<ExitCode> Checkpoint::start_new(const runtime::FilmHeader& header, const runtime::Settings& settings,
                                              const Streams& streams) {
  known_ = runtime::stamp_of(path_);
  if (!known_) return std::nullopt;
  const auto head = runtime::read_film_header(path_, limits_);
  if (const auto* read_error = std::get_if<runtime::FilmReadError>(&head))
    return check_replaceable(*read_error, streams);
  std::vector<std::string> problems = differences(std::get<runtime::FilmFile>(head), header, settings);
  if (!problems.empty()) {
    if (named_) {
      problems.push_back(remedy());
      return fail(streams, kBadScene, fmt::format("`{}` is the checkpoint of another render", path_), problems);
    }
    note(streams, fmt::format(kWillBeReplaced, path_));
    return std::nullopt;
  }
  const auto whole = runtime::read_film(path_, limits_);
  if (const auto* read_error = std::get_if<runtime::FilmReadError>(&whole))
    return check_replaceable(*read_error, streams);
  const runtime::PartialRender& there = std::get<runtime::FilmFile>(whole).render;
  if (!runtime::can_resume(there, settings)) {
    return check_replaceable({fmt::format(kNoSense, path_), false, false}, streams);
  }
  const double samples = static_cast<double>(there.film.samples()) / static_cast<double>(there.film.area().pixels());
  return fail(
      streams, kUsage,
      fmt::format("`{}` holds {:.2f} samples per pixel of this very render, which would be lost", path_, samples),
      {"add --resume to go on from it", remedy()});
}

// Decides about a file that cannot be resumed. If the name was not given by the user, a damaged film may be replaced.
// A file that was never a film is not ours and stays.
std::optional<ExitCode> Checkpoint::check_replaceable(const runtime::FilmReadError& read_error,
                                                      const Streams& streams) const {
  if (read_error.missing) return fail(streams, kIo, read_error.problem, {remedy()});
  if (read_error.not_a_film) return fail(streams, kBadScene, read_error.problem, {kElsewhere});
  if (named_) return fail(streams, kBadScene, read_error.problem, {remedy()});
  note(streams, read_error.problem + "; it will be replaced by this render's checkpoint");
  return std::nullopt;
}

std::optional<ExitCode> Checkpoint::check_path(const Streams& streams) const {
  if (const auto problem = runtime::check_file_path(path_)) {
    return fail(streams, kIo, *problem, {kElsewhere});
  }
  return std::nullopt;
}

void Checkpoint::tick(const runtime::FilmHeader& header, const runtime::RenderOptions::SnapshotReader& snapshot,
                      double seconds, const Streams& streams) {
  if (due_ == 0) due_ = seconds + interval_;
  if (seconds < due_) return;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  save(
      [&](runtime::AtomicFile& file) {
        snapshot([&](const runtime::PartialRender& render) { runtime::write_film(header, render, file); });
      },
      streams);
  const double took = std::chrono::duration<double>(Clock::now() - start).count();
  due_ = seconds + took + std::max(interval_, took / kMaxShare);
}

bool Checkpoint::write(const runtime::FilmHeader& header, const runtime::PartialRender& render,
                       const Streams& streams) {
  return save([&](runtime::AtomicFile& file) { runtime::write_film(header, render, file); }, streams);
}

// Detects a file that another run has put at the path, except between the last check and the renaming. Syncing, which
// may take seconds, comes before both.
bool Checkpoint::save(const std::function<void(runtime::AtomicFile&)>& fill, const Streams& streams) {
  runtime::AtomicFile file(path_);
  bool another = replaced_by_another();
  if (!another) {
    fill(file);
    problem_ = file.commit([&] { return !(another = replaced_by_another()); });
  }
  if (another) problem_ = problem_of_another();
  if (!problem_) {
    known_ = file.stamp();
    is_own_ = true;
    ++written_;
  } else if (!warned_) {
    warned_ = true;
    warn(streams, fmt::format("no checkpoint: {}", *problem_));
    streams.err.flush();
  }
  return !problem_;
}

// A file that has disappeared does not count as replaced.
bool Checkpoint::replaced_by_another() const {
  const auto there = runtime::stamp_of(path_);
  return there && there != known_;
}

std::string Checkpoint::problem_of_another() const {
  return fmt::format(
      "another run has written `{}` meanwhile, which stays as it is; --checkpoint FILE gives each a file "
      "of its own",
      path_);
}

void Checkpoint::remove(const Streams& streams) {
  std::error_code ignored;
  if (is_own_ && replaced_by_another()) {
    warn(streams, problem_of_another());
  } else if (is_own_) {
    const auto target = std::filesystem::canonical(path_, ignored);
    if (!ignored) std::filesystem::remove(target, ignored);
    std::filesystem::remove(path_, ignored);  // if path_ was a link
  }
  is_own_ = false;
}

}  // namespace fathom::cli
