// How far the units of a plan are, by their files.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "runtime/cli/options/unit_options.h"
#include "runtime/cli/plan/render_plan.h"

namespace fathom::cli {

struct PlanStatus {
  std::uint64_t units = 0, done = 0, begun = 0, broken = 0;  // begun: there is a checkpoint
  std::vector<UnitRange> left;  // to be rendered, in order; of tasks where those are asked for
  std::vector<std::pair<std::uint64_t, std::string>> faults;  // the first of the broken, and why

  std::uint64_t missing() const { return units - done - begun - broken; }
};

// Of the units in `range`. With `per_task` above 1 `left` has the tasks of so many units that have some to be
// rendered. Reads the heads of films, or with `sums` all of them. An ExitCode, after a message, when the folder is of
// another plan.
std::variant<PlanStatus, ExitCode> status_of(const RenderPlan& plan, const std::string& folder, UnitRange range,
                                             std::uint64_t per_task, bool sums, const compiler::Limits& limits,
                                             const Streams& streams);

std::string text_of(const std::vector<UnitRange>& ranges);  // "3,7,10-19"

// `fathom plan --status`: prints it. Done when all units are, else 1.
struct StatusRequest {
  std::string plan;
  std::uint64_t per_task = 1;
  bool sums = false, json = false;
};
int print_status(const StatusRequest& request, const compiler::Limits& limits, const Streams& streams);

}  // namespace fathom::cli
