// All files that a render writes: images, cost maps, statistics and the checkpoint.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/cli/options/streams.h"
#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// Returns the files of the finished image: the image, its layers and its cost maps.
std::vector<std::string> finished_files(const RenderRequest& request);

// Returns every file that the render will write, except streams.
std::vector<std::string> output_files(const RenderRequest& request);

// Checks in advance, as far as possible, that every file can be written. Otherwise prints a message and returns an
// exit code.
std::optional<ExitCode> check_outputs(const RenderRequest& request, const Streams& streams);

}  // namespace fathom::cli
