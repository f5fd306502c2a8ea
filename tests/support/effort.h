// How much a test of random cases tries.
#pragma once

// There when AddressSanitizer's runtime is linked. Tests are compiled the same with it and without.
extern "C" void __asan_init() __attribute__((weak));

namespace fathom::test {

// `n` cases, or an eighth of them under the sanitizers: there everything takes ten times as long, and what they look
// for shows in few cases as in many.
inline int few(int n) { return __asan_init != nullptr ? (n + 7) / 8 : n; }

}  // namespace fathom::test
