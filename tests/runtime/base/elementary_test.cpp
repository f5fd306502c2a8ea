#include "runtime/base/elementary.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace fathom::runtime::elementary_test {
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

TEST_CASE("elementary: sine and cosine of a turn in double are within 1e-15 of libm's, and exact at quarters") {
  double worst = 0;
  for (int i = -(1 << 18); i <= 1 << 19; ++i) {
    const double u = i * 0x1p-18 + (i % 7) * 1e-9;
    const SinCosReal angle = sincos_turn(u);
    // The remainder of a turn is exact. The product with 2 pi is exact except for its last bit.
    const double x = 2 * M_PI * (u - std::round(u));
    worst = std::max({worst, std::abs(std::sin(x) - angle.sin), std::abs(std::cos(x) - angle.cos)});
  }
  CHECK(worst <= 1e-15);
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const SinCosReal angle = sincos_turn(quarter / 4.0);
    CHECK((angle.sin == (quarter % 2 == 0 ? 0 : (quarter & 3) == 1 ? 1 : -1)));
    CHECK((angle.cos == (quarter % 2 != 0 ? 0 : (quarter & 3) == 0 ? 1 : -1)));
  }
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

TEST_CASE("elementary: log2, exp2 and powers in double are within their bounds of libm's", "[runtime]") {
  double worst_log = 0, worst_exp = 0, worst_power = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x = std::exp2(-300 + 600 * (i + 0.5) / 200000), truth = std::log2(x);
    worst_log = std::max(worst_log, std::abs(log2(x) - truth) / (1 + std::abs(truth)));
    const double y = -1000 + 2000 * (i + 0.5) / 200000;
    worst_exp = std::max(worst_exp, std::abs(exp2(y) / std::exp2(y) - 1));
    for (const double power_of : {0.2, 2.2, 2.4, -1.5}) {
      const double expected = std::pow(x, power_of);
      const double scale = 1 + std::abs(power_of * truth);
      worst_power = std::max(worst_power, std::abs(power(x, power_of) / expected - 1) / scale);
    }
  }
  for (double x = 0.5; x < 2; x += 1e-5) worst_log = std::max(worst_log, std::abs(log2(x) - std::log2(x)));
  CHECK(worst_log <= 4e-16);
  CHECK(worst_exp <= 1e-15);
  CHECK(worst_power <= 1e-15);
  for (int n = -1000; n <= 1000; ++n) {
    CHECK(exp2(static_cast<double>(n)) == std::ldexp(1.0, n));
    CHECK(log2(std::ldexp(1.0, n)) == n);
  }
  CHECK(log2(0x1p-1074) == -1074);
  CHECK(power(0, 2.2) == 0);
}

TEST_CASE("elementary: sRGB decoded and encoded is the same signal", "[runtime]") {
  double worst = 0;
  for (double signal = 0; signal <= 1; signal += 1e-4) {
    worst = std::max(worst, std::abs(srgb_encode(srgb_decode(signal)) - signal));
  }
  CHECK(worst <= 1e-7);  // the two pieces of the sRGB standard meet with a step of 3e-8 in linear light
  CHECK(srgb_decode(0) == 0);
  CHECK(srgb_decode(1) == 1);
  CHECK(srgb_decode(0.5) == Approx(0.21404114));
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
}  // namespace fathom::runtime::elementary_test
