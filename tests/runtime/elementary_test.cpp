#include "runtime/elementary.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace fathom::runtime {
namespace {

TEST_CASE("elementary: sine and cosine of a turn are within 2e-7 of libm's", "[runtime]") {
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

TEST_CASE("elementary: exp is within 2e-7 of libm's, and ends where float does", "[runtime]") {
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

TEST_CASE("elementary: exp2 is exact for whole exponents", "[runtime]") {
  for (int n = -30; n <= 30; ++n) CHECK(exp2(static_cast<float>(n)) == std::ldexp(1.0f, n));
  CHECK(static_cast<double>(exp2(0.5f)) == Approx(std::sqrt(2.0)).epsilon(3e-7));
}

TEST_CASE("elementary: log is within 3e-7 of libm's, from the smallest float to the largest", "[runtime]") {
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

TEST_CASE("elementary: the tangent is within 1e-14 of libm's", "[runtime]") {
  double worst = 0;
  for (double x = 1e-3; x < 1.57; x += 1e-3) worst = std::max(worst, std::abs(tangent(x) / std::tan(x) - 1));
  CHECK(worst <= 1e-13);  // near pi/2 the quotient magnifies the cosine's last bit
  CHECK(tangent(M_PI / 4) == Approx(1).epsilon(1e-15));
}

TEST_CASE("elementary: sRGB follows the standard", "[runtime]") {
  CHECK(srgb_encode(-1) == 0);
  CHECK(srgb_encode(NAN) == 0);
  CHECK(srgb_encode(2) == 1);
  CHECK(srgb_encode(INFINITY) == 1);
  double worst = 0;
  for (double x = 0.0032; x < 1; x += 1e-4) {
    worst = std::max(worst, std::abs(srgb_encode(x) - (1.055 * std::pow(x, 1 / 2.4) - 0.055)));
  }
  CHECK(worst <= 1e-13);
  CHECK(srgb_encode(0.002) == Approx(0.02584));
}

}  // namespace
}  // namespace fathom::runtime
