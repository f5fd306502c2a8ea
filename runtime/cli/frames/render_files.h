// The files that a render writes beside each other: pictures, maps of costs, counts and the checkpoint.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/cli/options/streams.h"
#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// Those that the picture is in, with its layers and costs.
std::vector<std::string> finished_files(const RenderRequest& request);

// Every file the run will write, but for streams.
std::vector<std::string> output_files(const RenderRequest& request);

// Whether every file could be written, as far as can be known before there is anything to write.
std::optional<ExitCode> check_outputs(const RenderRequest& request, const Streams& streams);

}  // namespace fathom::cli
