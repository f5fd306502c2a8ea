// The compiled frames of a plan, from which its units are rendered.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/cli/frames/scene_frames.h"
#include "runtime/cli/picture/prepared_render.h"
#include "runtime/cli/plan/render_plan.h"

namespace fathom::cli {

class PlanFrames {
 public:
  // The plan may be incomplete while it is being made, with only a scene and arguments.
  PlanFrames(const RenderPlan& plan, const Streams& streams)
      : plan_(plan), streams_(streams), input_{plan.source, {}} {}

  // Parses the plan's arguments together with `running`, which the plan does not record. `background` is the file of
  // the environment map, empty if there is none. Returns an exit code after a message on failure.
  std::optional<ExitCode> open(const std::vector<std::string>& running, const std::string& background);
  // Returns the frame with an index, valid until another frame is requested. `area` is the part that will be rendered
  // and must fit into memory, by default the whole frame.
  std::variant<PreparedRender*, ExitCode> at(int index, const std::optional<runtime::PixelRect>& area = {});

 private:
  ExitCode fail_at(int index, ExitCode code) const;
  std::optional<ExitCode> check(const PreparedRender& picture, int index) const;

  const RenderPlan& plan_;
  const Streams& streams_;
  SceneInput input_;
  RenderRequest request_;
  std::optional<Sequence> sequence_;
  RenderCache cache_;
  std::unique_ptr<PreparedRender> picture_;
  int index_ = -1;
};

}  // namespace fathom::cli
