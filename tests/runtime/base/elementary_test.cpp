#include "runtime/base/elementary.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>

namespace fathom::runtime::elementary_test {
namespace {

TEST_CASE("elementary: sine and cosine of a turn are within 2e-7 of libm's", "[base]") {
  double worst = 0;
  for (int i = 0; i <= 1 << 20; ++i) {
    const float u = static_cast<float>(i) * 0x1p-20f;
    const SinCos angle = sincos_turn(u);
    const double x = 2 * M_PI * static_cast<double>(u);
    worst = std::max({worst, std::abs(std::sin(x) - static_cast<double>(angle.sin)),
                      std::abs(std::cos(x) - static_cast<double>(angle.cos))});
  }
  CHECK(worst <= 2e-7);
}

TEST_CASE("elementary: exp is within 2e-7 of libm's, and ends where float does", "[base]") {
  double worst = 0;
  for (double x = -86; x < 88; x += 1e-4) {
    const float rounded = static_cast<float>(x);
    const double truth = std::exp(static_cast<double>(rounded));
    worst = std::max(worst, std::abs(static_cast<double>(exp(rounded)) / truth - 1));
  }
  CHECK(worst <= 2e-7);
  CHECK(exp(0.0f) == 1);
  CHECK(exp(-1000.0f) == 0);
  CHECK(exp(-INFINITY) == 0);
  CHECK(std::isinf(exp(89.0f)));
  CHECK(std::isnan(exp(NAN)));
}

TEST_CASE("elementary: log is within 3e-7 of libm's, from the smallest float to the largest", "[base]") {
  double worst = 0;
  const auto check = [&](float x) {
    const double truth = std::log(static_cast<double>(x));
    if (truth != 0) worst = std::max(worst, std::abs(static_cast<double>(log(x)) / truth - 1));
  };
  for (std::uint32_t bits = 1; bits < 0x7f800000; bits += 3001) check(std::bit_cast<float>(bits));
  for (int i = -100000; i <= 100000; ++i) check(1 + static_cast<float>(i) * 0x1p-23f);
  CHECK(worst <= 3e-7);
  CHECK(log(1.0f) == 0);
  CHECK(log(0.0f) == -INFINITY);
  CHECK(log(INFINITY) == INFINITY);
  CHECK(std::isnan(log(-1.0f)));
  CHECK(std::isnan(log(NAN)));
}

}  // namespace
}  // namespace fathom::runtime::elementary_test
