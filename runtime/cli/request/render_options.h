// The options of `fathom render`, and which of them `fathom plan` has, too.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <span>
#include <string>
#include <variant>

#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

// Those that say what is rendered, whatever files it goes to and however the work is done.
void add_picture_options(Arguments& arguments, RenderRequest& request);

// The request for what a plan says with options of add_picture_options() and --define, and whoever runs it with those
// in `running`: a plan comes from strangers, and can neither name files nor raise limits. Or the exit code after a
// message.
std::variant<RenderRequest, ExitCode> parse_planned(std::span<const std::string> planned,
                                                    std::span<const std::string> running, const Streams& streams);

// The request, or the exit code after help or a message.
std::variant<RenderRequest, int> parse_render(std::span<const std::string> args, const Streams& streams);

}  // namespace fathom::cli
