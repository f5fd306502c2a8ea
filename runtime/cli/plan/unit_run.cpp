#include "runtime/cli/plan/unit_run.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <ostream>

#include "runtime/cli/input/memory.h"
#include "runtime/cli/picture/render_job.h"
#include "runtime/cli/plan/plan_frames.h"

namespace fathom::cli {
namespace {

// Long, because units are short and thousands of machines may write to one disk. A signal still triggers a checkpoint
// at any time.
constexpr double kUnitCheckpointInterval = 600;  // seconds

class UnitRun {
 public:
  UnitRun(const RenderRequest& request, const RenderPlan& plan, const Streams& streams,
          std::optional<Interruption>& interruption)
      : request_(request),
        plan_(plan),
        streams_(streams),
        interruption_(interruption),
        folder_(units_folder(*request.units.plan)),
        pictures_(plan, streams) {}

  ExitCode run(const std::vector<UnitRange>& ranges) {
    if (const auto code = claim_folder(folder_, plan_, streams_)) return *code;
    for (const UnitRange& range : ranges) {
      for (std::uint64_t number = range.first; number < range.last; ++number) {
        if (interruption_->stop()) return kInterrupted;
        interruption_->begin_preparation();
        if (const ExitCode code = render(number); code != kDone) return code;
      }
    }
    if (!request_.quiet) close();
    return kDone;
  }

 private:
  ExitCode render(std::uint64_t number) {
    const PlanUnit unit = unit_of(plan_.grid, number);
    const std::string file = unit_file(folder_, number);
    if (is_there(file, unit)) {
      ++there_;
      return kDone;
    }
    if (const auto code = open()) return *code;
    const auto frame = pictures_.at(unit.frame_index, unit.area);
    if (const auto* code = std::get_if<ExitCode>(&frame)) return *code;
    PreparedRender& picture = *std::get<PreparedRender*>(frame);
    RenderRequest& request = picture.request;
    request.unit = number;
    request.outputs = {Output{file, nullptr}};
    request.resume = true;
    request.checkpoint_interval = request.checkpoint_interval.value_or(kUnitCheckpointInterval);
    request.options.crop = unit.area;
    request.options.sample_range = unit.samples;
    request.options.resume_from = nullptr;
    RenderJob job(picture, streams_, nullptr, interruption_);
    const ExitCode code = job.run();
    rendered_ += job.complete();
    return code;
  }

  // Prepares the rendering on first use, so that nothing is compiled if all units exist already.
  std::optional<ExitCode> open() {
    if (opened_) return std::nullopt;
    opened_ = true;
    std::string background;
    if (!plan_.background_name.empty()) {
      background = folder_ + "/background" + std::filesystem::path(plan_.background_name).extension().string();
      if (const auto problem = write_text(plan_.background, background)) return fail(streams_, kIo, *problem);
    }
    return pictures_.open(request_.units.running, background);
  }

  bool is_there(const std::string& file, const PlanUnit& unit) const {
    auto read = runtime::read_film_header(file, read_limits(request_.scene.limits));
    if (const auto* read_error = std::get_if<runtime::FilmReadError>(&read)) {
      if (!read_error->missing) note(streams_, fmt::format("{}; rendered again", read_error->problem));
      return false;
    }
    const auto fault = fault_of(std::get<runtime::FilmFile>(read), plan_, unit);
    if (fault) note(streams_, fmt::format("`{}`: {}; rendered again", file, *fault));
    return !fault;
  }

  void close() const {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::string line = fmt::format("{} of {}: {} rendered in {:.2f} s", count_of(rendered_ + there_, "unit"),
                                   *request_.units.plan, rendered_, seconds);
    if (there_ > 0) line += fmt::format(", {} there already", there_);
    streams_.err << line << '\n';
  }

  const RenderRequest& request_;
  const RenderPlan& plan_;
  const Streams& streams_;
  std::optional<Interruption>& interruption_;
  const std::string folder_;
  PlanFrames pictures_;
  bool opened_ = false;
  std::size_t rendered_ = 0, there_ = 0;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

ExitCode render_units(const RenderRequest& request, const Streams& streams,
                      std::optional<Interruption>& interruption) {
  if (!interruption) interruption.emplace();
  const auto plan = read_plan(*request.units.plan, request.scene.limits, streams);
  if (const auto* code = std::get_if<ExitCode>(&plan)) return *code;
  const auto& made = std::get<RenderPlan>(plan);
  const auto ranges = units_of(request.units, made.grid.units(), streams);
  if (const auto* code = std::get_if<ExitCode>(&ranges)) return *code;
  return UnitRun(request, made, streams, interruption).run(std::get<std::vector<UnitRange>>(ranges));
}

}  // namespace fathom::cli
