// The limit of memory: what a verb is about to take, and whether it may.
// Tested by: tests/runtime/cli/cli_limits_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/limits.h"
#include "runtime/cli/render_request.h"
#include "runtime/cli/streams.h"
#include "runtime/image/image_read.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// Bytes: what the limit says, or three quarters of the machine's memory.
double allowed_memory(const compiler::Limits& limits);

runtime::ReadLimits read_limits(const compiler::Limits& limits);

// Bytes a pixel: of the picture that is written, three floats and what is encoded of them; of the denoiser's work.
inline constexpr double kPictureBytes = 24, kDenoiserBytes = 128;

// Bytes as "12 MiB".
std::string in_words(double bytes);

// An ExitCode, after a message, when the render would take more than is allowed: kUsage when its size is the command
// line's, else kBadScene.
std::optional<ExitCode> check_memory(const RenderRequest& request, const compiler::CompiledScene& scene,
                                     const Streams& streams);

// Leaves the render's regions no more memory than the limit leaves beside the film: they change no picture.
void fit_regions(RenderRequest& request, const compiler::CompiledScene& scene);

}  // namespace fathom::cli
