#include "runtime/cli/frames/sequence.h"

#include <fmt/format.h>

#include <chrono>
#include <ostream>

#include "runtime/cli/frames/frame_journal.h"
#include "runtime/cli/frames/render_files.h"
#include "runtime/cli/frames/scene_frames.h"
#include "runtime/cli/picture/prepared_render.h"
#include "runtime/cli/picture/render_job.h"

namespace fathom::cli {
namespace {

class FrameRun {
 public:
  FrameRun(const RenderRequest& request, const SceneInput& input, const Sequence& sequence, const Streams& streams,
           std::optional<Interruption>& interruption)
      : request_(request),
        input_(input),
        sequence_(sequence),
        streams_(streams),
        interruption_(interruption),
        journal_path_(FrameJournal::path_for(request.outputs.front().path)),
        journal_(journal_path_) {}

  ExitCode run() {
    if (const auto code = check()) return *code;
    for (int index = 0; index < sequence_.frames.count(); ++index) {
      if (interruption_->stop()) return stop(index, "interrupted", kInterrupted);
      interruption_->begin_preparation();
      const auto left = time_left();
      if (left && !(*left > 0)) return stop(index, "the time limit ended the sequence", kDone);
      const ExitCode code = render(index);
      if (code != kDone) return code;
      if (!last_complete_) return stop(index, "the time limit ended the sequence", kDone);
    }
    close();
    return kDone;
  }

 private:
  using Clock = std::chrono::steady_clock;

  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  std::optional<double> time_left() const {
    const auto& limit = request_.options.time_limit;
    return limit ? std::optional(*limit - seconds()) : std::nullopt;
  }

  // Returns the render request for one frame.
  RenderRequest request_of(int index) const {
    const int frame = sequence_.frames.at(index);
    RenderRequest request = request_;
    request.scene = sequence_.at(request.scene, frame);
    for (Output& output : request.outputs) {
      const bool folder = output.folder();
      output.path = numbered(output.path, frame);
      if (folder) output.path += fmt::format(".{}", ending_of(output));
    }
    for (std::optional<std::string>* file : {&request.cost_map, &request.stats_json, &request.checkpoint}) {
      if (*file) *file = numbered(**file, frame);
    }
    request.frame = {frame, index, sequence_.frames.count()};
    request.frames.fps = sequence_.fps;
    request.options.time_limit = time_left();
    return request;
  }

  // Checks everything that can be checked before the first frame is compiled.
  std::optional<ExitCode> check() {
    std::vector<std::string> files = {journal_path_};
    for (int index = 0; index < sequence_.frames.count(); ++index) {
      const RenderRequest request = request_of(index);
      for (std::string& file : output_files(request)) files.push_back(std::move(file));
      const auto checkpoint = checkpoint_of(request);
      if (request_.resume || !runtime::stamp_of(checkpoint->path())) continue;
      return fail(streams_, kUsage,
                  fmt::format("`{}` is there, so that frame {} was begun before and would be begun anew",
                              checkpoint->path(), request.frame->number),
                  {"add --resume to go on from it", fmt::format("or remove `{}`", checkpoint->path())});
    }
    if (const auto code = claim_outputs(files, streams_)) return code;
    if (const auto code = check_outputs(request_of(0), streams_)) return code;
    if (const auto problem = runtime::check_file_path(journal_path_)) return fail(streams_, kIo, *problem);
    if (const auto code = journal_.read(streams_)) return code;
    if (request_.resume && journal_.empty()) {
      note(streams_, fmt::format("there is no journal `{}`: no frame is known to be done", journal_path_));
    }
    return std::nullopt;
  }

  ExitCode render(int index) {
    const RenderRequest request = request_of(index);
    const int frame = request.frame->number;
    auto prepared = prepare_render(request, input_, cache_, streams_);
    if (const auto* code = std::get_if<ExitCode>(&prepared)) return fail_at(frame, *code);
    PreparedRender& picture = *std::get<std::unique_ptr<PreparedRender>>(prepared);
    RenderJob job(picture, streams_, nullptr, interruption_);
    last_complete_ = true;
    if (request.resume && journal_.has(frame, job.header(), picture.request)) {
      ++there_;
      return kDone;
    }
    const ExitCode code = job.run();
    last_complete_ = job.complete();
    if (!job.complete()) {
      if (code != kDone && code != kInterrupted) return fail_at(frame, code);
      return code;
    }
    ++rendered_;
    regions_built_ += job.stats().region_bytes > 0 && job.stats().regions_reused == 0;
    regions_kept_ += job.stats().regions_reused;
    if (const auto problem = journal_.add(frame, job.header(), picture.request)) return fail(streams_, kIo, *problem);
    return code;
  }

  ExitCode fail_at(int frame, ExitCode code) const {
    return fail(streams_, code,
                fmt::format("{} of {} cannot be rendered", sequence_.describe(frame), request_.scene.path),
                {fmt::format("{} before it {} done; none after it is", count_of(done(), "frame"),
                             done() == 1 ? "is" : "are")});
  }

  // Reports that the sequence ended before the frame `index` was completed.
  ExitCode stop(int index, std::string_view why, ExitCode code) const {
    note(streams_, fmt::format("{} at frame {}: {} of {} are done; --resume goes on", why, sequence_.frames.at(index),
                               done(), count_of(static_cast<std::size_t>(sequence_.frames.count()), "frame")));
    return code;
  }

  std::size_t done() const { return rendered_ + there_; }

  void close() const {
    if (request_.quiet) return;
    std::string line = fmt::format("{} of {}: {} rendered in {:.1f} s", count_of(done(), "frame"),
                                   request_.scene.path, rendered_, seconds());
    if (there_ > 0) line += fmt::format(", {} there already", there_);
    if (regions_built_ + regions_kept_ > 0) {
      line += fmt::format(", regions built {} and kept {}", count_of(regions_built_, "time"),
                          count_of(regions_kept_, "time"));
    }
    streams_.err << line << '\n';
  }

  const RenderRequest& request_;
  const SceneInput& input_;
  const Sequence& sequence_;
  const Streams& streams_;
  std::optional<Interruption>& interruption_;
  const std::string journal_path_;
  FrameJournal journal_;
  RenderCache cache_;
  bool last_complete_ = true;
  std::size_t rendered_ = 0, there_ = 0;
  std::size_t regions_built_ = 0, regions_kept_ = 0;
  const Clock::time_point start_ = Clock::now();
};

}  // namespace

ExitCode render_frames(const RenderRequest& request, const Streams& streams,
                       std::optional<Interruption>& interruption) {
  if (!interruption) interruption.emplace();
  auto input = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&input)) return *code;
  const auto sequence = sequence_of(request.frames, std::get<SceneInput>(input), request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&sequence)) return *code;
  return FrameRun(request, std::get<SceneInput>(input), std::get<Sequence>(sequence), streams, interruption).run();
}

}  // namespace fathom::cli
