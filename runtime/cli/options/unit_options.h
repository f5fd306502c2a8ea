// The options of `fathom render` that name units of a plan (runtime/cli/plan/render_plan.h).
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/cli/options/arguments.h"

namespace fathom::cli {

// Units from `first` to before `last`.
struct UnitRange {
  std::uint64_t first = 0, last = 0;
};

struct UnitOptions {
  std::optional<std::string> plan;        // FILE
  std::optional<std::uint64_t> unit;      // --unit K, or what a queue's variable says
  bool from_queue = false;                // --unit env
  std::vector<UnitRange> ranges;          // --units
  std::optional<std::uint64_t> per_task;  // `unit` counts tasks of so many units

  std::vector<std::string> running;  // the arguments beside these: how the work is done

  bool given() const { return plan || unit || from_queue || !ranges.empty() || per_task; }
};

void add_unit_options(Arguments& arguments, UnitOptions& options);

// Takes what is `given` beside them. An ExitCode, after a message, when it is not clear which units are meant, or
// when options are given that the plan has already.
std::optional<ExitCode> check_units(UnitOptions& options, const std::vector<Arguments::Given>& given,
                                    const Streams& streams);

// The units of a plan of `count`, in the order asked for, or the exit code after a message when some are not in it.
// Reads the variables of queues.
std::variant<std::vector<UnitRange>, ExitCode> units_of(const UnitOptions& options, std::uint64_t count,
                                                        const Streams& streams);

// "3,7,10-19": what --units reads and queues take for their arrays.
Verdict read_units(std::string_view text, std::vector<UnitRange>& ranges);
std::string text_of(const UnitRange& range);

}  // namespace fathom::cli
