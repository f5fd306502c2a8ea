#include "runtime/cli/plan/plan_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "runtime/cli/input/memory.h"
#include "runtime/cli/plan/plan_status.h"
#include "runtime/denoise/denoise.h"

namespace fathom::cli {

void override_tone(const MergeRequest& request, runtime::Attributes& attributes) {
  if (request.exposure) attributes["fathom.exposure"] = static_cast<float>(*request.exposure);
  if (request.tone >= 0) {
    attributes["fathom.tone"] = std::string(compiler::kToneCurves[static_cast<std::size_t>(request.tone)]);
  }
}

namespace {

class PlanMerge {
 public:
  PlanMerge(const MergeRequest& request, const RenderPlan& plan, const Streams& streams)
      : request_(request), plan_(plan), streams_(streams), folder_(units_folder(*request.plan)) {
    denoise_ = request.denoise || std::ranges::find(plan.arguments, "--denoise") != plan.arguments.end();
  }

  ExitCode run() {
    if (const auto code = check_frames()) return *code;
    for (const auto& step : {&PlanMerge::check, &PlanMerge::merge}) {
      for (int index = 0; index < frame_count(); ++index) {
        if (!is_asked(index)) continue;
        if (const auto code = (this->*step)(index)) return *code;
      }
    }
    return kDone;
  }

 private:
  std::uint64_t first_unit(int index) const {
    return static_cast<std::uint64_t>(index) * plan_.grid.units_of_frame();
  }
  std::string name_of(int index) const {
    return plan_.grid.frames ? fmt::format("frame {}", plan_.grid.frames->at(index)) : "the picture";
  }

  int frame_count() const { return static_cast<int>(plan_.grid.frame_count()); }

  bool is_asked(int index) const {
    const auto& wanted = request_.frames.range;
    if (!wanted || !plan_.grid.frames) return true;
    const int frame = plan_.grid.frames->at(index);
    return frame >= wanted->first && frame < wanted->last && (frame - wanted->first) % wanted->step == 0;
  }

  std::optional<ExitCode> check_frames() const {
    if (!request_.frames.range) return std::nullopt;
    if (!plan_.grid.frames) return fail(streams_, kUsage, "--frames: the plan is of a still");
    for (int index = 0; index < frame_count(); ++index) {
      if (is_asked(index)) return std::nullopt;
    }
    return fail(streams_, kUsage, "--frames: the plan has none of them");
  }

  // Checks by the film headers that all units of the frame exist.
  std::optional<ExitCode> check(int index) const {
    const std::uint64_t first = first_unit(index);
    const auto looked =
        status_of(plan_, folder_, {first, first + plan_.grid.units_of_frame()}, 1, false, request_.limits, streams_);
    if (const auto* code = std::get_if<ExitCode>(&looked)) return *code;
    const auto& status = std::get<PlanStatus>(looked);
    if (status.done == status.units) return std::nullopt;
    Help help = {
        fmt::format("render them: fathom render --plan {} --units {}", *request_.plan, text_of(status.left))};
    for (const auto& [unit, reason] : status.faults) help.push_back(reason);
    return fail(
        streams_, status.broken > 0 ? kBadScene : kIo,
        fmt::format("{} lacks {} of {}", name_of(index), status.units - status.done, count_of(status.units, "unit")),
        help);
  }

  // Reads the film of a unit and checks that it belongs to the same render as `first`.
  std::variant<runtime::FilmFile, ExitCode> read(std::uint64_t number, const runtime::FilmFile* first) const {
    const std::string file = unit_file(folder_, number);
    auto read = runtime::read_film(file, read_limits(request_.limits));
    if (const auto* read_error = std::get_if<runtime::FilmReadError>(&read)) {
      return fail(streams_, read_error->missing ? kIo : kBadScene, read_error->problem,
                  {fmt::format("render it again: fathom render --plan {} --unit {}", *request_.plan, number)});
    }
    auto& film = std::get<runtime::FilmFile>(read);
    if (const auto fault = fault_of(film, plan_, unit_of(plan_.grid, number))) {
      return fail(streams_, kBadScene, fmt::format("`{}`: {}", file, *fault));
    }
    auto differ = runtime::differences(first ? first->header.identity : film.header.identity, film.header.identity,
                                       "in the first unit", "here");
    if (first && film.shape.layers != first->shape.layers) differ.push_back("their layers differ");
    if (differ.empty()) return std::move(film);
    return fail(streams_, kBadScene, fmt::format("`{}` is of another render than the frame's first unit", file),
                differ);
  }

  // Merges the units of a frame. The whole frame and one unit are in memory at the same time.
  std::optional<ExitCode> merge(int index) const {
    const PlanGrid& grid = plan_.grid;
    const std::uint64_t begin = first_unit(index);
    auto read_first = read(begin, nullptr);
    if (const auto* code = std::get_if<ExitCode>(&read_first)) return *code;
    const auto& first = std::get<runtime::FilmFile>(read_first);
    if (const auto code = check_memory(first.shape)) return *code;
    runtime::FilmHeader header = first.header;
    header.samples = {0, grid.spp};
    runtime::PartialRender sum{
        runtime::Film({0, 0, grid.width, grid.height}, first.shape.layers), std::vector<runtime::Coverage>(1), {}};
    add(sum, first);
    for (std::uint64_t number = begin + 1; number < begin + grid.units_of_frame(); ++number) {
      auto unit = read(number, &first);
      if (const auto* code = std::get_if<ExitCode>(&unit)) return *code;
      add(sum, std::get<runtime::FilmFile>(unit));
    }
    sum.covered.front().add({{0, 0, grid.width, grid.height}, {0, grid.spp}});
    return write(index, header, sum);
  }

  void add(runtime::PartialRender& sum, const runtime::FilmFile& unit) const {
    if (!sum.film.merge(unit.render.film)) warn(streams_, overflow_text("samples of a unit"));
  }

  std::optional<ExitCode> check_memory(const runtime::FilmShape& shape) const {
    const auto film = static_cast<double>(runtime::Film::memory_per_pixel(shape.layers, shape.stages));
    const double each = film + kImageBytes + (denoise_ ? kDenoiserBytes : 0);
    const double needed =
        each * plan_.grid.width * plan_.grid.height + film * static_cast<double>(shape.area.pixels());
    const double allowed = allowed_memory(request_.limits);
    if (needed <= allowed) return std::nullopt;
    return fail(
        streams_, kBadScene,
        fmt::format("a frame would take {} of memory; {} are allowed", format_bytes(needed), format_bytes(allowed)),
        {compiler::raise(&compiler::Limits::memory, needed)});
  }

  std::optional<ExitCode> write(int index, runtime::FilmHeader& header, runtime::PartialRender& sum) const {
    if (denoise_ && (!sum.film.layers().first_hit || !sum.film.layers().halves)) {
      return fail(streams_, kBadScene, "--denoise: the films lack what it takes", {"plan with --denoise, too"});
    }
    override_tone(request_, header.attributes);
    if (denoise_) runtime::denoise(sum.film, 0);
    ImageFiles pictures = request_.pictures;
    pictures.noisy = denoise_;
    for (Output& output : pictures.outputs) {
      if (plan_.grid.frames && !output.standard()) output.path = numbered(output.path, plan_.grid.frames->at(index));
    }
    std::vector<std::string> lines;
    const auto problem = write_image_files(pictures, header, sum, std::nullopt, lines, streams_);
    for (const std::string& line : lines) {
      if (!request_.quiet) streams_.err << line << '\n';
    }
    return problem ? std::optional(fail(streams_, kIo, *problem)) : std::nullopt;
  }

  const MergeRequest& request_;
  const RenderPlan& plan_;
  const Streams& streams_;
  const std::string folder_;
  bool denoise_ = false;
};

}  // namespace

ExitCode merge_plan(const MergeRequest& request, const Streams& streams) {
  const auto read = read_plan(*request.plan, request.limits, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  const auto& plan = std::get<RenderPlan>(read);
  const bool stream = std::ranges::any_of(request.pictures.outputs, [](const Output& o) { return o.standard(); });
  if (stream && plan.grid.frames) return fail(streams, kUsage, "`-o -` takes one picture, and the plan has frames");
  runtime::keep_freed_memory();
  return PlanMerge(request, plan, streams).run();
}

}  // namespace fathom::cli
