// Checks for options of `fathom render` that conflict with the destination of its images: standard output, or a file
// per frame.
// Tested by: tests/runtime/cli/options/cli_output_test.cpp, tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <optional>

#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// Prints a message and returns an exit code if another option of the request conflicts with `-o -`.
std::optional<ExitCode> check_standard_output(const RenderRequest& request, const Streams& streams);

// Prints a message and returns an exit code if another option of the request conflicts with --frames, or if the
// request has an option that needs --frames without --frames.
std::optional<ExitCode> check_frames(const RenderRequest& request, const Streams& streams);

}  // namespace fathom::cli
