// The options of `fathom render`, some of which `fathom plan` shares.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <span>
#include <string>
#include <variant>

#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// Adds the options that define the image, independent of output files and of how the work is done.
void add_image_options(Arguments& arguments, RenderRequest& request);

// Parses the request of a plan. `planned` holds the plan's options: those of add_image_options() and --define.
// `running` holds the options of the user who runs the plan. A plan may come from a stranger, so its options can
// neither name files nor raise limits. Prints a message and returns an exit code if options are invalid.
std::variant<RenderRequest, ExitCode> parse_planned(std::span<const std::string> planned,
                                                    std::span<const std::string> running, const Streams& streams);

// Parses the command line. Prints help or a message and returns an exit code if there is nothing to render.
std::variant<RenderRequest, int> parse_render(std::span<const std::string> args, const Streams& streams);

}  // namespace fathom::cli
