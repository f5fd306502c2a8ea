// The options of `fathom render` for long renders and for renders of parts.
// Tested by: tests/runtime/cli/picture/cli_checkpoint_test.cpp, tests/runtime/cli/cli_merge_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/scene/compiled_scene.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// Ending of a checkpoint's default name.
inline constexpr const char* kCheckpointEnding = ".checkpoint";

struct LongRender {
  std::optional<std::string> checkpoint;  // FILE
  std::optional<double> interval;         // seconds
  bool resume = false;
  std::optional<double> time_limit;  // seconds
  std::optional<runtime::SampleRange> sample_range;
};

// Adds --checkpoint-interval only.
void add_interval_option(Arguments& arguments, LongRender& request);
void add_long_render_options(Arguments& arguments, LongRender& request);

// Merges the options into the render options, overriding the scene's settings. Prints a message and returns an exit
// code if they conflict.
std::optional<ExitCode> apply(const LongRender& request, const compiler::CompiledScene& scene,
                              runtime::RenderOptions& options, const Streams& streams);

}  // namespace fathom::cli
