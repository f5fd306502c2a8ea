// The options of `fathom render` that select units of a plan (runtime/cli/plan/render_plan.h).
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/cli/options/arguments.h"

namespace fathom::cli {

// Half-open range of units.
struct UnitRange {
  std::uint64_t first = 0, last = 0;
};

struct UnitOptions {
  std::optional<std::string> plan;        // FILE
  std::optional<std::uint64_t> unit;      // --unit K, or the value of a queue's variable
  bool from_queue = false;                // --unit env
  std::vector<UnitRange> ranges;          // --units
  std::optional<std::uint64_t> per_task;  // `unit` counts tasks of this many units

  std::vector<std::string> running;  // other arguments, which only affect how the work is done

  bool given() const { return plan || unit || from_queue || !ranges.empty() || per_task; }
};

void add_unit_options(Arguments& arguments, UnitOptions& options);

// Takes over the other arguments in `given`. Prints a message and returns an exit code if the selected units are
// ambiguous, or if `given` has options that the plan already defines.
std::optional<ExitCode> check_units(UnitOptions& options, const std::vector<Arguments::ParsedOption>& given,
                                    const Streams& streams);

// Returns the selected units of a plan with `count` units, in the requested order. Prints a message and returns an
// exit code if the plan lacks some of them. Reads the environment variables of queues.
std::variant<std::vector<UnitRange>, ExitCode> units_of(const UnitOptions& options, std::uint64_t count,
                                                        const Streams& streams);

// Reads "3,7,10-19", the format of --units and of queues' array options.
OptionResult read_units(std::string_view text, std::vector<UnitRange>& ranges);
std::string text_of(const UnitRange& range);

}  // namespace fathom::cli
