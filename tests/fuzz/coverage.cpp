// Coverage counters for libFuzzer in code that g++ compiles. g++ calls __sanitizer_cov_trace_pc at every branch
// (option -fsanitize-coverage=trace-pc), which libFuzzer itself no longer handles. The linker redirects these calls
// to this file (--wrap), which counts them per call site in counters that libFuzzer reads in addition to its own
// (libFuzzer defines the section's name). A fuzz run prints these counts as features, "ft:", while "cov:" stays 0.
#include <cstdint>

namespace {

constexpr int kBits = 17;
__attribute__((section("__libfuzzer_extra_counters"), used)) std::uint8_t counters[1u << kBits];

}  // namespace

extern "C" void __wrap___sanitizer_cov_trace_pc() {
  const auto from = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  ++counters[(from * 0x9E3779B97F4A7C15u) >> (64 - kBits)];
}

// g++ also calls these hooks for comparisons of floats, which libFuzzer does not use.
extern "C" void __sanitizer_cov_trace_cmpf(float, float) {}
extern "C" void __sanitizer_cov_trace_cmpd(double, double) {}
