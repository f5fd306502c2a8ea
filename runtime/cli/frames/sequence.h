// `fathom render --frames`: renders one image per frame in sequence, with the frame's number in the file names, and
// keeps a journal from which an interrupted run resumes.
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp, tests/suites/frames
#pragma once

#include <optional>

#include "runtime/cli/picture/interruption.h"
#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// Renders all requested frames.
ExitCode render_frames(const RenderRequest& request, const Streams& streams,
                       std::optional<Interruption>& interruption);

}  // namespace fathom::cli
