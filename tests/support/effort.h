// How much a test of random cases tries.
#pragma once

namespace fathom::test {

// `n` cases, or an eighth of them under the sanitizers: there everything takes ten times as long, and what they look for
// shows in few cases as in many.
constexpr int few(int n) {
#ifdef FATHOM_SANITIZED
  return (n + 7) / 8;
#else
  return n;
#endif
}

}  // namespace fathom::test
