// Options of `fathom render` that do not go with where its pictures go: to standard output, or to a file for each
// frame.
// Tested by: tests/runtime/cli/options/cli_output_test.cpp, tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <optional>

#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// An ExitCode, after a message, when another option of the request does not go with `-o -`.
std::optional<ExitCode> check_standard_output(const RenderRequest& request, const Streams& streams);

// An ExitCode, after a message, when another option of the request does not go with --frames, or one that does is
// given without.
std::optional<ExitCode> check_frames(const RenderRequest& request, const Streams& streams);

}  // namespace fathom::cli
