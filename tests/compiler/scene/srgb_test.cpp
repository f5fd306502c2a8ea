#include "compiler/scene/srgb.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>

namespace fathom::compiler::srgb_test {
namespace {

TEST_CASE("sRGB: a signal decoded and encoded is the same signal", "[scene][srgb]") {
  double worst = 0;
  for (double signal = 0; signal <= 1; signal += 1e-4) {
    worst = std::max(worst, std::abs(srgb_encode(srgb_decode(signal)) - signal));
  }
  CHECK(worst <= 1e-7);  // the two pieces of the sRGB standard meet with a step of 3e-8 in linear light
  CHECK(srgb_decode(0) == 0);
  CHECK(srgb_decode(1) == 1);
  CHECK(srgb_decode(0.5) == Approx(0.21404114));
}

TEST_CASE("sRGB: the conversion follows the standard", "[scene][srgb]") {
  CHECK(srgb_encode(-1) == 0);
  CHECK(srgb_encode(NAN) == 0);
  CHECK(srgb_encode(2) == 1);
  CHECK(srgb_encode(INFINITY) == 1);
  double worst = 0;
  for (double x = 0.0032; x < 1; x += 1e-4) {
    worst = std::max(worst, std::abs(srgb_encode(x) - (1.055 * std::pow(x, 1 / 2.4) - 0.055)));
  }
  CHECK(worst <= 2e-15);
  CHECK(srgb_encode(0.002) == Approx(0.02584));
}

}  // namespace
}  // namespace fathom::compiler::srgb_test
