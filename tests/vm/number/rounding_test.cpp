// Canary for the compiler bug that -fno-tree-slp-vectorize works around: g++ 12 at -O2 drops the rounding of double
// -> float -> double for two of three adjacent struct members. A float ray compared in double does exactly that
// conversion.
#include "tests/support/catch.h"

namespace fathom::test::rounding_test {
namespace {

struct Three {
  double x, y, z;
};

[[gnu::noinline]] Three rounded(const double* from) {
  Three three;
  three.x = static_cast<double>(static_cast<float>(from[0]));
  three.y = static_cast<double>(static_cast<float>(from[1]));
  three.z = static_cast<double>(static_cast<float>(from[2]));
  return three;
}

}  // namespace

TEST_CASE("three rounded members hold rounded values", "[number][canary]") {
  volatile double source[] = {0.1, 0.2, 0.3};
  const double from[] = {source[0], source[1], source[2]};
  const Three three = rounded(from);
  CHECK(three.x == 0x1.99999ap-4);  // the floats nearest to 0.1, 0.2 and 0.3
  CHECK(three.y == 0x1.99999ap-3);
  CHECK(three.z == 0x1.333334p-2);
}

}  // namespace fathom::test::rounding_test
