#include "runtime/cli/plan/plan_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/cli/picture/render_identity.h"
#include "runtime/cli/request/render_options.h"

namespace fathom::cli {

std::optional<ExitCode> PlanFrames::open(const std::vector<std::string>& running, const std::string& background) {
  auto parsed = parse_planned(plan_.arguments, running, streams_);
  if (const auto* code = std::get_if<ExitCode>(&parsed)) return *code;
  request_ = std::get<RenderRequest>(std::move(parsed));
  request_.scene.path = plan_.source.name();
  request_.frames.all = false;
  request_.frames.range = plan_.grid.frames;
  if (!background.empty()) {
    const auto code = cache_background(background, plan_.background_name, request_.scene, cache_, streams_);
    if (code) return *code;
  }
  if (!plan_.grid.frames) return std::nullopt;
  const auto sequence = sequence_of(request_.frames, input_, request_.scene, streams_);
  if (const auto* code = std::get_if<ExitCode>(&sequence)) return *code;
  sequence_ = std::get<Sequence>(sequence);
  return std::nullopt;
}

std::variant<PreparedRender*, ExitCode> PlanFrames::at(int index, const std::optional<runtime::PixelRect>& area) {
  if (index == index_) return picture_.get();
  picture_ = nullptr;  // scenes are large, so only one is kept
  RenderRequest request = request_;
  request.options.crop = area;
  if (sequence_) {
    const int frame = sequence_->frames.at(index);
    request.scene = sequence_->at(request.scene, frame);
    request.frame = {frame, index, sequence_->frames.count()};
    request.frames.fps = sequence_->fps;
  }
  auto prepared = prepare_render(request, input_, cache_, streams_);
  if (const auto* code = std::get_if<ExitCode>(&prepared)) return fail_at(index, *code);
  picture_ = std::get<std::unique_ptr<PreparedRender>>(std::move(prepared));
  if (const auto code = check(*picture_, index)) return *code;
  index_ = index;
  return picture_.get();
}

ExitCode PlanFrames::fail_at(int index, ExitCode code) const {
  if (!sequence_) return code;
  return fail(streams_, code, fmt::format("{} cannot be rendered", sequence_->describe(sequence_->frames.at(index))));
}

// Checks that this program would render the same as the program that made the plan.
std::optional<ExitCode> PlanFrames::check(const PreparedRender& picture, int index) const {
  if (plan_.identity.empty()) return std::nullopt;  // the plan is being made
  const runtime::RenderOptions& options = picture.request.options;
  runtime::Identity there = plan_.identity,
                    here = render_identity(picture.scene, resolve(picture.scene, options), options);
  if (index > 0) there = without_frame(there), here = without_frame(here);
  std::vector<std::string> differ = runtime::differences(there, here, "in the plan", "in this program");
  if (differ.empty()) return std::nullopt;
  differ.push_back("make the plan and render its units with the same program");
  return fail(streams_, kBadScene, "the plan is of another render", differ);
}

}  // namespace fathom::cli
