// The limit of memory: what a verb is about to take, and whether it may.
// Tested by: tests/runtime/cli_limits_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/limits.h"
#include "runtime/cli/render_request.h"
#include "runtime/cli/streams.h"
#include "runtime/image_read.h"
#include "runtime/options.h"

namespace fathom::cli {

// Bytes: what the limit says, or three quarters of the machine's memory.
double allowed_memory(const compiler::Limits& limits);

runtime::ReadLimits read_limits(const compiler::Limits& limits);

// Of the picture that is written, three floats and what is encoded of them; of the denoiser's work. Bytes a pixel.
inline constexpr double kPicture = 24, kDenoising = 128;

// Bytes as "12 MiB".
std::string in_words(double bytes);

// What a film of so many stages takes for each pixel, bytes (runtime/film.h).
double film_bytes_per_pixel(const runtime::FilmLayers& layers, std::size_t stages);

// What a render takes for each pixel, bytes: of the film, of denoising it and of the picture written.
double bytes_per_pixel(const runtime::Settings& settings, bool denoise);

// An ExitCode, after a message, when the render would take more than is allowed: kUsage when its size is the command
// line's, else kBadScene.
std::optional<ExitCode> check_memory(const RenderRequest& request, const compiler::CompiledScene& scene,
                                     const Streams& streams);

}  // namespace fathom::cli
