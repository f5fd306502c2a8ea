// What libFuzzer steers by where g++ compiles: g++ calls __sanitizer_cov_trace_pc at every branch (the option
// -fsanitize-coverage=trace-pc), which libFuzzer no longer listens to itself. The linker sends these calls here
// (--wrap), and here they are counted, by where they come from, in counters that libFuzzer reads beside its own: the
// section's name is libFuzzer's. A fuzz run prints what it finds as features, "ft:"; "cov:" stays 0.
#include <cstdint>

namespace {

constexpr int kBits = 17;
__attribute__((section("__libfuzzer_extra_counters"), used)) std::uint8_t counters[1u << kBits];

}  // namespace

extern "C" void __wrap___sanitizer_cov_trace_pc() {
  const auto from = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  ++counters[(from * 0x9E3779B97F4A7C15u) >> (64 - kBits)];
}

// Which floats are compared is nothing that libFuzzer asks.
extern "C" void __sanitizer_cov_trace_cmpf(float, float) {}
extern "C" void __sanitizer_cov_trace_cmpd(double, double) {}
