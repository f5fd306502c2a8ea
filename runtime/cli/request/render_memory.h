// Predicts the memory of a render, and limits the memory of its regions.
// Tested by: tests/runtime/cli/input/cli_limits_test.cpp
#pragma once

#include <optional>

#include "compiler/scene/compiled_scene.h"
#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// Prints a message and returns an exit code if the render would take more memory than is allowed: kUsage if the
// command line sets the size, else kBadScene.
std::optional<ExitCode> check_memory(const RenderRequest& request, const compiler::CompiledScene& scene,
                                     const Streams& streams);

// Limits the render's regions to the memory that the limit leaves in addition to the film. Regions do not change the
// image.
void fit_regions(RenderRequest& request, const compiler::CompiledScene& scene);

}  // namespace fathom::cli
