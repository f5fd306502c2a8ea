// The limit of memory: the bytes that a verb may use, and the bytes needed for images and for denoising.
// Tested by: tests/runtime/cli/input/cli_limits_test.cpp
#pragma once

#include <string>

#include "compiler/source/limits.h"
#include "runtime/denoise/denoise.h"
#include "runtime/image/image_read.h"
#include "runtime/load/files.h"

namespace fathom::cli {

using runtime::allowed_memory;

runtime::ReadLimits read_limits(const compiler::Limits& limits);

// Bytes per pixel of the image being written: three floats and their encoded form.
inline constexpr double kImageBytes = 24;
using runtime::kDenoiserBytes;

// Formats bytes as "12 MiB".
std::string format_bytes(double bytes);

}  // namespace fathom::cli
