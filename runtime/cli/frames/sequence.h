// `fathom render --frames`: a picture for each frame, one after the other, in files that have its number in their
// names; and a journal of them, by which a run that was ended goes on.
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp, scripts/frames-test
#pragma once

#include <optional>

#include "runtime/cli/picture/interruption.h"
#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// All frames that the request asks for.
ExitCode render_frames(const RenderRequest& request, const Streams& streams,
                       std::optional<Interruption>& interruption);

}  // namespace fathom::cli
