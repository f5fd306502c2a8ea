// The default scenes of `fathom chart`. CMake embeds the files' texts into the program.
// Tested by: tests/runtime/cli/cli_chart_test.cpp
#pragma once

#include <span>
#include <string_view>

namespace fathom::cli {

struct ChartScene {
  std::string_view path;  // relative to the project
  std::string_view text;
};

std::span<const ChartScene> chart_scenes();

}  // namespace fathom::cli
