// Decimal exponents and powers of ten are exact: a number that people read is rounded by them.
#include "vm/number/decimal.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "tests/support/catch.h"

namespace fathom::test::decimal_test {

using namespace vm::real;

TEST_CASE("decimal: a power of ten is the nearest double, and its exponent is known", "[number]") {
  for (int exponent = -323; exponent <= 308; ++exponent) {
    const double power = power_of_ten(exponent);
    CAPTURE(exponent);
    CHECK(power == std::strtod(("1e" + std::to_string(exponent)).c_str(), nullptr));
    CHECK(decimal_exponent(power) == exponent);
    CHECK(decimal_exponent(std::nextafter(power, 0)) == exponent - 1);
    CHECK(decimal_exponent(std::nextafter(-power, -std::numeric_limits<double>::infinity())) == exponent);
    if (exponent > -308) CHECK(log10(power) == Approx(exponent).epsilon(1e-14).margin(1e-15));  // else subnormal
  }
}

TEST_CASE("decimal: zero, infinity and NaN have the exponent 0", "[number]") {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double x : {0.0, -0.0, infinity, -infinity, std::nan("")}) CHECK(decimal_exponent(x) == 0);
}

}  // namespace fathom::test::decimal_test
