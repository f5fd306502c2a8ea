// The command line of `fathom chart` as data.
// Tested by: tests/runtime/cli/cli_chart_test.cpp
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>

#include "runtime/cli/input/scene_arguments.h"
#include "runtime/cli/options/streams.h"
#include "runtime/measure/measure_images.h"

namespace fathom::cli {

struct ChartRequest {
  SceneArguments scene;  // empty path: the project's own scenes
  std::string folder;
  int rays = 10000, rounds = 9;
  std::uint64_t seed = 1;
  runtime::ImagePlan images;
  bool no_images = false, quiet = false;
  std::string command;  // command line as given
};

// Returns the request, or the exit code after printing help or a message.
std::variant<ChartRequest, int> parse_chart(std::span<const std::string> args, const Streams& streams);

}  // namespace fathom::cli
