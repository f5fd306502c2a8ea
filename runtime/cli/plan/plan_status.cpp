#include "runtime/cli/plan/plan_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "runtime/cli/input/memory.h"
#include "runtime/cli/request/render_request.h"

namespace fathom::cli {
namespace {

constexpr std::size_t kMaxFaults = 10;

// Returns the fault of the unit's film, nullopt if the film is complete.
std::optional<std::string> fault_in(const std::string& file, const RenderPlan& plan, const PlanUnit& unit, bool sums,
                                    const runtime::ReadLimits& limits) {
  const auto read = sums ? runtime::read_film(file, limits) : runtime::read_film_header(file, limits);
  if (const auto* read_error = std::get_if<runtime::FilmReadError>(&read)) return read_error->problem;
  return fault_of(std::get<runtime::FilmFile>(read), plan, unit);
}

// Appends a range that is not empty and begins no earlier than the last one ends, or within the last task.
void append(std::vector<UnitRange>& ranges, UnitRange range) {
  if (!ranges.empty() && range.first <= ranges.back().last) {
    ranges.back().last = std::max(ranges.back().last, range.last);
  } else {
    ranges.push_back(range);
  }
}

void print_json(const PlanStatus& status, const PlanGrid& grid, const Streams& streams) {
  nlohmann::ordered_json json = {{"units", status.units}, {"done", status.done},     {"missing", status.missing()},
                                 {"begun", status.begun}, {"broken", status.broken}, {"left", text_of(status.left)}};
  if (grid.frames) json["frames"] = fmt::format("{}:{}:{}", grid.frames->first, grid.frames->last, grid.frames->step);
  json["faults"] = nlohmann::ordered_json::array();
  for (const auto& [unit, reason] : status.faults) json["faults"].push_back({{"unit", unit}, {"reason", reason}});
  print(streams, json.dump(1) + "\n");
}

}  // namespace

std::variant<PlanStatus, ExitCode> status_of(const RenderPlan& plan, const std::string& folder, UnitRange range,
                                             std::uint64_t per_task, bool sums, const compiler::Limits& limits,
                                             const Streams& streams) {
  const auto found = find_folder(folder, plan, streams);
  if (const auto* code = std::get_if<ExitCode>(&found)) return *code;
  PlanStatus status;
  status.units = range.last - range.first;
  std::uint64_t next = range.first;
  const auto leave = [&](std::uint64_t last) {  // the units from `next`
    if (next < last) append(status.left, {next / per_task, (last - 1) / per_task + 1});
  };
  for (const auto& [number, files] : unit_files(folder, range)) {
    const std::string film = unit_file(folder, number);
    const auto fault = files.film ? fault_in(film, plan, unit_of(plan.grid, number), sums, read_limits(limits))
                                  : std::optional<std::string>();
    if (files.film && !fault) {
      leave(number);
      next = number + 1;
      ++status.done;
      if (files.checkpoint) status.useless.push_back(film + kCheckpointEnding);
    } else if (fault) {
      ++status.broken;
      if (status.faults.size() < kMaxFaults) status.faults.emplace_back(number, *fault);
    } else {
      ++status.begun;
    }
  }
  leave(range.last);
  return status;
}

std::string text_of(const std::vector<UnitRange>& ranges) {
  std::string text;
  for (const UnitRange& range : ranges) {
    if (!text.empty()) text += ',';
    text += text_of(range);
  }
  return text;
}

int print_status(const StatusRequest& request, const compiler::Limits& limits, const Streams& streams) {
  const auto read = read_plan(request.plan, limits, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  const auto& plan = std::get<RenderPlan>(read);
  const auto looked = status_of(plan, units_folder(request.plan), {0, plan.grid.units()}, request.per_task,
                                request.sums, limits, streams);
  if (const auto* code = std::get_if<ExitCode>(&looked)) return *code;
  const auto& status = std::get<PlanStatus>(looked);
  const bool complete = status.done == status.units;
  for (const std::string& checkpoint : status.useless) {
    std::error_code error;
    const bool removed = std::filesystem::remove(checkpoint, error);
    note(streams, fmt::format("`{}` lay beside its finished film{}", checkpoint, removed ? " and was removed" : ""));
  }
  if (request.json) {
    print_json(status, plan.grid, streams);
    return complete ? kDone : kFoundProblems;
  }
  print(streams, fmt::format("{} of {}: {} done, {} missing, {} begun, {} broken\n", count_of(status.units, "unit"),
                             request.plan, status.done, status.missing(), status.begun, status.broken));
  for (const auto& [unit, reason] : status.faults) print(streams, fmt::format("unit {}: {}\n", unit, reason));
  if (status.broken > status.faults.size())
    print(streams, fmt::format("and {} more\n", status.broken - status.faults.size()));
  if (!complete) {
    print(streams,
          fmt::format("{} to be rendered: {}\n", request.per_task > 1 ? "tasks" : "units", text_of(status.left)));
  }
  return complete ? kDone : kFoundProblems;
}

}  // namespace fathom::cli
