// The frames of a plan, compiled: what its units are rendered of.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/cli/frames/scene_frames.h"
#include "runtime/cli/picture/picture.h"
#include "runtime/cli/plan/render_plan.h"

namespace fathom::cli {

class PlannedPictures {
 public:
  // The plan may be one that is still being made: with a scene and arguments alone.
  PlannedPictures(const RenderPlan& plan, const Streams& streams)
      : plan_(plan), streams_(streams), input_{plan.source, {}} {}

  // `running` are arguments beside the plan's. The background's picture is in the file `background`, where there is
  // one. An ExitCode after a message.
  std::optional<ExitCode> open(const std::vector<std::string>& running, const std::string& background);
  // The frame with that index, until another is asked for. `area` is what is going to be rendered of it and has to
  // fit into memory: where nothing is said, the frame.
  std::variant<Picture*, ExitCode> at(int index, const std::optional<runtime::PixelRect>& area = {});

 private:
  ExitCode fail_at(int index, ExitCode code) const;
  std::optional<ExitCode> check(const Picture& picture, int index) const;

  const RenderPlan& plan_;
  const Streams& streams_;
  SceneInput input_;
  RenderRequest request_;
  std::optional<Sequence> sequence_;
  KeptWork kept_;
  std::unique_ptr<Picture> picture_;
  int index_ = -1;
};

}  // namespace fathom::cli
