#include "runtime/cli/input/memory.h"

#include <fmt/format.h>

namespace fathom::cli {

std::string format_bytes(double bytes) {
  constexpr double kMiB = 1 << 20, kGiB = 1 << 30;
  return bytes < kGiB ? fmt::format("{:.0f} MiB", bytes / kMiB) : fmt::format("{:.1f} GiB", bytes / kGiB);
}

runtime::ReadLimits read_limits(const compiler::Limits& limits) { return {allowed_memory(limits)}; }

}  // namespace fathom::cli
