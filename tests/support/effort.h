// How much a test of random cases tries.
#pragma once

#include <cstdlib>

// There when AddressSanitizer's runtime is linked. Tests are compiled the same with it and without.
extern "C" void __asan_init() __attribute__((weak));

namespace fathom::test {

// `n` cases, or an eighth of them under the sanitizers and on emulated processors (FATHOM_FEW_CASES), where everything
// takes ten times as long: what these look for shows in few cases as in many.
inline int few(int n) {
  static const bool all = __asan_init == nullptr && std::getenv("FATHOM_FEW_CASES") == nullptr;
  return all ? n : (n + 7) / 8;
}

}  // namespace fathom::test
