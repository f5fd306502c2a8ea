#include "runtime/cli/options/unit_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <string_view>

#include "runtime/cli/options/values.h"

namespace fathom::cli {
namespace {

constexpr std::int64_t kMaxUnit = std::int64_t{1} << 40;

// Environment variables in which queues pass a task's number, and the number of the first task.
struct QueueVariable {
  const char* name;
  int first;
};
constexpr std::array kQueueVariables = {
    QueueVariable{"SLURM_ARRAY_TASK_ID", 0},       QueueVariable{"JOB_COMPLETION_INDEX", 0},
    QueueVariable{"AWS_BATCH_JOB_ARRAY_INDEX", 0}, QueueVariable{"SGE_TASK_ID", 1},
    QueueVariable{"PBS_ARRAY_INDEX", 0},
};

std::string variable_names() {
  std::vector<std::string_view> names;
  for (const QueueVariable& row : kQueueVariables) names.emplace_back(row.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

OptionResult read_unit(std::string_view text, UnitOptions& options) {
  options.from_queue = text == "env";
  options.unit.reset();
  if (options.from_queue) return std::nullopt;
  std::int64_t number = 0;
  if (auto error = read_whole(text, 0, kMaxUnit, number)) {
    return OptionError{error->problem, "the first unit is 0; env takes the number from a queue's variable"};
  }
  options.unit = static_cast<std::uint64_t>(number);
  return std::nullopt;
}

// Returns the task's number, counted from 0, from the first variable that is set.
std::variant<std::uint64_t, ExitCode> queue_number(const Streams& streams) {
  for (const QueueVariable& row : kQueueVariables) {
    const char* text = std::getenv(row.name);
    if (text == nullptr || *text == 0 || std::string_view(text) == "undefined") continue;
    std::int64_t number = 0;
    if (const auto error = read_whole(text, row.first, kMaxUnit, number)) {
      return fail(streams, kUsage, fmt::format("--unit env: {}={}: {}", row.name, text, error->problem));
    }
    return static_cast<std::uint64_t>(number - row.first);
  }
  return fail(streams, kUsage, "--unit env: no queue has set the number of a task", {"they are " + variable_names()});
}

constexpr std::array<std::string_view, 4> kUnitNames = {"--plan", "--unit", "--units", "--per-task"};
// Options allowed together with kUnitNames, because they only affect how the work is done.
constexpr std::array<std::string_view, 7> kRunning = {
    "--threads", "--limit", "--quiet", "--verbose", "--profile", "--checkpoint-interval", "--error-format"};

}  // namespace

void add_unit_options(Arguments& arguments, UnitOptions& options) {
  arguments.group("Units of a plan (docs/how-to/farm.md)");
  arguments.option("--plan", "FILE",
                   "Render units of this plan of `fathom plan`, which has the scene and its settings",
                   any_text(options.plan));
  arguments.option("--unit", "K", "The unit's number; env takes it from a queue: " + variable_names(),
                   [&options](std::string_view text) { return read_unit(text, options); });
  arguments.option("--units", "LIST", "Several, one after the other: K:L, the second not among them, or 3,7,10-19",
                   [&options](std::string_view text) { return read_units(text, options.ranges); });
  arguments.option("--per-task", "N", "--unit is the number of a task of N units", [&options](std::string_view text) {
    std::int64_t number = 0;
    const OptionResult error = read_whole(text, 1, kMaxUnit, number);
    if (!error) options.per_task = static_cast<std::uint64_t>(number);
    return error;
  });
}

std::optional<ExitCode> check_units(UnitOptions& options, const std::vector<Arguments::ParsedOption>& given,
                                    const Streams& streams) {
  if (!options.plan) {
    return fail(streams, kUsage, "a unit is one of a plan, which is missing", {"name it with --plan FILE"});
  }
  const bool one = options.unit || options.from_queue;
  if (one == !options.ranges.empty()) {
    return fail(streams, kUsage, one ? "--unit does not go with --units" : "--plan: which units?",
                {"--unit K renders one, --units K:L several"});
  }
  if (options.per_task && !one) return fail(streams, kUsage, "--per-task goes with --unit");
  for (const Arguments::ParsedOption& option : given) {
    if (std::ranges::find(kUnitNames, option.name) != kUnitNames.end()) continue;
    if (std::ranges::find(kRunning, option.name) != kRunning.end()) {
      std::ranges::copy(option.arguments(), std::back_inserter(options.running));
      continue;
    }
    return fail(streams, kUsage, fmt::format("{} does not go with --plan, which has all settings", option.name),
                {"make another plan"});
  }
  return std::nullopt;
}

std::variant<std::vector<UnitRange>, ExitCode> units_of(const UnitOptions& options, std::uint64_t count,
                                                        const Streams& streams) {
  std::vector<UnitRange> ranges = options.ranges;
  if (ranges.empty()) {
    std::uint64_t number = options.unit.value_or(0);
    if (options.from_queue) {
      const auto read = queue_number(streams);
      if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
      number = std::get<std::uint64_t>(read);
    }
    const std::uint64_t each = options.per_task.value_or(1);
    ranges.push_back({number * each, number * each + each});
    // The last task may have fewer units.
    if (ranges.back().first < count) ranges.back().last = std::min(ranges.back().last, count);
  }
  for (const UnitRange& range : ranges) {
    if (range.last <= count) continue;
    return fail(streams, kUsage, fmt::format("the plan has no unit {}", std::max(range.first, count)),
                {fmt::format("its units are 0 to {}", count - 1)});
  }
  return ranges;
}

OptionResult read_units(std::string_view text, std::vector<UnitRange>& ranges) {
  const OptionError wrong{fmt::format("`{}` are no units", text),
                          "write K:L, the second not among them, or 3,7,10-19, the second among them"};
  for (std::string_view rest = text;;) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    const std::string_view part = rest.substr(0, end);
    const std::size_t mark = part.find_first_of(":-");
    std::int64_t first = 0, last = 0;
    if (read_whole(part.substr(0, mark), 0, kMaxUnit, first)) return wrong;
    last = first + 1;
    if (mark != part.npos) {
      if (read_whole(part.substr(mark + 1), 0, kMaxUnit, last)) return wrong;
      last += part[mark] == '-';
    }
    if (last <= first) return wrong;
    ranges.push_back({static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(last)});
    if (end == rest.size()) return std::nullopt;
    rest.remove_prefix(end + 1);
  }
}

std::string text_of(const UnitRange& range) {
  if (range.last == range.first + 1) return fmt::format("{}", range.first);
  return fmt::format("{}-{}", range.first, range.last - 1);
}

}  // namespace fathom::cli
