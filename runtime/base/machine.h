// The part of the machine that this process may use.
// Tested by: tests/runtime/base/machine_test.cpp
#pragma once

#include <filesystem>
#include <optional>

namespace fathom::runtime {

// Returns the number of processors that this process may use, at least 1: those of its affinity mask, and no more than
// the quota of its control group, rounded up. std::thread::hardware_concurrency() counts those of the machine.
int usable_processors();

// Returns the bytes of memory that this process may use: the machine's, or the limit of its control group.
double usable_memory();

// The limits of the control groups of a process. `process` is its folder in /proc, `root` the folder of all control
// groups. Source: cgroups(7); Linux kernel, Documentation/admin-guide/cgroup-v2.rst and cgroup-v1/.
class ControlGroups {
 public:
  explicit ControlGroups(std::filesystem::path process = "/proc/self", std::filesystem::path root = "/sys/fs/cgroup");

  std::optional<double> processors() const;  // per wall-clock second; nothing without a quota
  std::optional<double> memory() const;      // bytes; nothing without a limit

 private:
  // Calls visit(folder) for the group of a controller and for all groups above it, in both versions.
  template <class Visit>
  void each(const char* controller, const Visit& visit) const;

  std::filesystem::path process_, root_;
};

}  // namespace fathom::runtime
