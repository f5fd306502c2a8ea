// `fathom render --plan`: renders units of a plan one after the other, each to a film of its own that is written
// atomically. A unit whose film is complete is skipped.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <optional>

#include "runtime/cli/picture/interruption.h"
#include "runtime/cli/request/render_request.h"

namespace fathom::cli {

ExitCode render_units(const RenderRequest& request, const Streams& streams,
                      std::optional<Interruption>& interruption);

}  // namespace fathom::cli
