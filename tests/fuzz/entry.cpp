// libFuzzer's entry point for the target that the build names. A broken promise ends the process. libFuzzer then
// reports a crash and keeps the input.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom::fuzz;
  static const Target& target = *find_target(FATHOM_FUZZ_TARGET);
  if (size > target.longest) return -1;  // libFuzzer discards the input
  try {
    target.run({data, size});
  } catch (const BrokenPromise& broken) {
    std::fprintf(stderr, "broken promise: %s\n", broken.what());
    std::abort();
  }
  return 0;
}
