// `fathom merge --plan`: merges the units of a plan into its frames, one frame after the other.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/source/limits.h"
#include "runtime/cli/options/frame_options.h"
#include "runtime/cli/picture/image_files.h"

namespace fathom::cli {

struct MergeRequest {
  std::vector<std::string> inputs;
  std::optional<std::string> plan;  // replaces `inputs`
  FrameOptions frames;              // frames of the plan to merge; default: all
  ImageFiles pictures;
  std::optional<double> exposure;
  int tone = -1;  // a compiler::ToneCurve; -1: not given
  int bits = 0;   // an index into 8, 16
  bool denoise = false, quiet = false;
  int format = -1;  // format of -o -, see apply_format()
  compiler::Limits limits;
};

// Overrides the exposure and tone curve of the films with those of the request.
void override_tone(const MergeRequest& request, runtime::Attributes& attributes);

ExitCode merge_plan(const MergeRequest& request, const Streams& streams);

}  // namespace fathom::cli
