// libFuzzer's way into the target that the build names: a broken promise ends the process, which libFuzzer reports as
// a crash and keeps the input of.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom::fuzz;
  static const Target& target = *find_target(FATHOM_FUZZ_TARGET);
  if (size > target.longest) return -1;  // libFuzzer forgets it
  try {
    target.run({data, size});
  } catch (const BrokenPromise& broken) {
    std::fprintf(stderr, "broken promise: %s\n", broken.what());
    std::abort();
  }
  return 0;
}
