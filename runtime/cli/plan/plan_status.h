// Progress of a plan's units, judged by their files.
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
  std::uint64_t units = 0, done = 0, begun = 0, broken = 0;   // begun: has a checkpoint
  std::vector<UnitRange> left;                                // units (or tasks) still to be rendered, ascending
  std::vector<std::pair<std::uint64_t, std::string>> faults;  // the first broken units and their faults
  std::vector<std::string> useless;                           // checkpoints beside finished films

  std::uint64_t missing() const { return units - done - begun - broken; }
};

// Returns the status of the units in `range`. With `per_task` above 1, `left` lists the tasks of that many units that
// have a unit left to render. Reads the films' headers, or with `sums` the whole films. Prints a message and returns
// an exit code if the folder belongs to another plan.
std::variant<PlanStatus, ExitCode> status_of(const RenderPlan& plan, const std::string& folder, UnitRange range,
                                             std::uint64_t per_task, bool sums, const compiler::Limits& limits,
                                             const Streams& streams);

std::string text_of(const std::vector<UnitRange>& ranges);  // for example "3,7,10-19"

// `fathom plan --status`: prints the status. Returns kDone if all units are done, else kFoundProblems.
struct StatusRequest {
  std::string plan;
  std::uint64_t per_task = 1;
  bool sums = false, json = false;
};
int print_status(const StatusRequest& request, const compiler::Limits& limits, const Streams& streams);

}  // namespace fathom::cli
