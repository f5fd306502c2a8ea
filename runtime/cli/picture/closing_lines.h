// The lines printed at the end of a render: the image, its rays and its time. The names of the files follow them.
//
//     drew ball.json: 32x16 pixels, 2 samples per pixel
//     rays: 1836, 41.2 % of them hit, 12 searched in double
//     time: 0.12 s on 2 threads, 4.51 million rays per second, peak memory 25.5 MB
//     wrote ball.png (32x16)
//
// Tested by: tests/runtime/cli/picture/cli_closing_test.cpp
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/render.h"

namespace fathom::cli {

// Returns three lines. Counts of failures appear only if they are not 0.
std::string closing_lines(std::string_view scene, const runtime::RenderResult& result);

// Returns one line for --watch that ends with the written files.
std::string closing_line(std::string_view scene, const runtime::RenderResult& result,
                         const std::vector<std::string>& written);

}  // namespace fathom::cli
