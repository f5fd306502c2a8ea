// A render whose picture goes to standard output, by `-o -`.
// Tested by: tests/runtime/cli/cli_output_test.cpp
#pragma once

#include <optional>

#include "runtime/cli/render_request.h"

namespace fathom::cli {

// An ExitCode, after a message, when another option of the request does not go with `-o -`.
std::optional<ExitCode> check_standard_output(const RenderRequest& request, const Streams& streams);

}  // namespace fathom::cli
