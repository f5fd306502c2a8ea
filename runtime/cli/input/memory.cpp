#include "runtime/cli/input/memory.h"

#include <fmt/format.h>
#include <unistd.h>

namespace fathom::cli {

std::string format_bytes(double bytes) {
  constexpr double kMiB = 1 << 20, kGiB = 1 << 30;
  return bytes < kGiB ? fmt::format("{:.0f} MiB", bytes / kMiB) : fmt::format("{:.1f} GiB", bytes / kGiB);
}

double allowed_memory(const compiler::Limits& limits) {
  if (limits.memory > 0) return limits.memory;
  const double machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return 0.75 * machine;
}

runtime::ReadLimits read_limits(const compiler::Limits& limits) { return {allowed_memory(limits)}; }

}  // namespace fathom::cli
