// The memory that a render is going to take, before it does, and how much of it is left to its regions.
// Tested by: tests/runtime/cli/input/cli_limits_test.cpp
#pragma once

#include <optional>

#include "compiler/scene/compiled_scene.h"
#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// An ExitCode, after a message, when the render would take more than is allowed: kUsage when its size is the command
// line's, else kBadScene.
std::optional<ExitCode> check_memory(const RenderRequest& request, const compiler::CompiledScene& scene,
                                     const Streams& streams);

// Leaves the render's regions no more memory than the limit leaves beside the film: they change no picture.
void fit_regions(RenderRequest& request, const compiler::CompiledScene& scene);

}  // namespace fathom::cli
