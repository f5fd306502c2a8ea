// The options of `fathom render` for renders that take long or are done in parts.
// Tested by: tests/runtime/cli/picture/cli_checkpoint_test.cpp, tests/runtime/cli/cli_merge_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/scene/compiled_scene.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// The ending of a checkpoint's name where --checkpoint does not say it.
inline constexpr const char* kCheckpointEnding = ".checkpoint";

struct LongRender {
  std::optional<std::string> checkpoint;  // FILE
  std::optional<double> interval;         // seconds
  bool resume = false;
  std::optional<double> time_limit;  // seconds
  std::optional<double> noise;
  std::optional<int> min_spp;
  std::optional<runtime::SampleRange> sample_range;
};

// --checkpoint-interval alone.
void add_interval_option(Arguments& arguments, LongRender& request);
void add_long_render_options(Arguments& arguments, LongRender& request);

// Puts them into the options, over the scene's settings. An ExitCode, after a message, when they do not go together.
std::optional<ExitCode> apply(const LongRender& request, const compiler::CompiledScene& scene,
                              runtime::RenderOptions& options, const Streams& streams);

}  // namespace fathom::cli
