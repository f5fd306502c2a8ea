#include "runtime/base/machine.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>
#include <utility>

namespace fathom::runtime {
namespace {

// A file that does not begin with a number has no limit: "max 100000".
std::optional<double> read_number(const std::filesystem::path& file) {
  double number = 0;
  std::ifstream text(file);
  return text >> number ? std::optional(number) : std::nullopt;
}

std::optional<double> ratio_in(const std::filesystem::path& file) {
  double quota = 0, period = 0;
  std::ifstream text(file);
  return text >> quota >> period && period > 0 ? std::optional(quota / period) : std::nullopt;
}

void lower(std::optional<double>& least, std::optional<double> limit) {
  if (limit && *limit > 0 && (!least || *limit < *least)) least = limit;
}

int affine_processors() {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(std::thread::hardware_concurrency());  // more processors than a cpu_set_t has
}

}  // namespace

ControlGroups::ControlGroups(std::filesystem::path process, std::filesystem::path root)
    : process_(std::move(process)), root_(std::move(root)) {}

template <class Visit>
void ControlGroups::each(const char* controller, const Visit& visit) const {
  std::ifstream groups(process_ / "cgroup");
  for (std::string line; std::getline(groups, line);) {  // number:controllers:path
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == line.npos) continue;
    const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
    const bool unified = controllers == ",,";
    if (!unified && controllers.find(std::string(",") + controller + ',') == controllers.npos) continue;
    const std::filesystem::path top = unified ? root_ : root_ / controller;
    // In a container the path can be the one outside of it, and its own group is the top.
    std::filesystem::path group = std::filesystem::path(line.substr(second + 1)).relative_path();
    for (;; group = group.parent_path()) {
      visit(top / group);
      if (group.empty()) break;
    }
  }
}

std::optional<double> ControlGroups::processors() const {
  std::optional<double> least;
  each("cpu", [&](const std::filesystem::path& group) {
    lower(least, ratio_in(group / "cpu.max"));
    const auto quota = read_number(group / "cpu.cfs_quota_us"), period = read_number(group / "cpu.cfs_period_us");
    if (quota && period && *period > 0) lower(least, *quota / *period);
  });
  return least;
}

std::optional<double> ControlGroups::memory() const {
  std::optional<double> least;
  each("memory", [&](const std::filesystem::path& group) {
    lower(least, read_number(group / "memory.max"));
    lower(least, read_number(group / "memory.limit_in_bytes"));
  });
  return least;
}

int usable_processors() {
  const double quota = std::ceil(ControlGroups().processors().value_or(1 << 20));
  return std::max(1, static_cast<int>(std::min<double>(affine_processors(), quota)));
}

double usable_memory() {
  const double machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return std::min(machine, ControlGroups().memory().value_or(machine));
}

}  // namespace fathom::runtime
