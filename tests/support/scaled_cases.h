// Number of cases that a randomised test runs.
#pragma once

#include <cstdlib>

// Weak symbol: not null only if AddressSanitizer's runtime is linked. Test objects are compiled the same with and
// without the sanitizers.
extern "C" void __asan_init() __attribute__((weak));

namespace fathom::test {

// True under the sanitizers and on emulated processors (FATHOM_FEW_CASES), where every case takes ten times as long.
// The errors that those runs look for show in few cases as well as in many.
inline bool few_cases() {
  static const bool few = __asan_init != nullptr || std::getenv("FATHOM_FEW_CASES") != nullptr;
  return few;
}

// Returns `n`, or n / 8 where there are few cases.
inline int scaled_cases(int n) { return few_cases() ? (n + 7) / 8 : n; }

}  // namespace fathom::test
