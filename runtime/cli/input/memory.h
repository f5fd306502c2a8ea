// The limit of memory: the bytes that a verb may take, and those that pictures and their denoising take.
// Tested by: tests/runtime/cli/input/cli_limits_test.cpp
#pragma once

#include <string>

#include "compiler/source/limits.h"
#include "runtime/image/image_read.h"

namespace fathom::cli {

// Bytes: what the limit says, or three quarters of the machine's memory.
double allowed_memory(const compiler::Limits& limits);

runtime::ReadLimits read_limits(const compiler::Limits& limits);

// Bytes a pixel: of the picture that is written, three floats and what is encoded of them; of the denoiser's work.
inline constexpr double kPictureBytes = 24, kDenoiserBytes = 128;

// Bytes as "12 MiB".
std::string in_words(double bytes);

}  // namespace fathom::cli
