// Prints the best instruction set of this machine that Highway and Fathom know, by its name in FATHOM_ISA.
#include <cstdio>

#include "hwy/targets.h"

int main() {
  const auto supported = hwy::SupportedTargets();
  std::fputs(supported & HWY_AVX3   ? "avx512"
             : supported & HWY_AVX2 ? "avx2"
             : supported & HWY_SSE4 ? "sse4"
             : supported & HWY_NEON ? "neon"
                                    : "scalar",
             stdout);
}
