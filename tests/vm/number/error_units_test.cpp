// Arithmetic of bounds that libm would compute differently on other processors.
#include <limits>

#include "tests/support/catch.h"
#include "vm/number/error_units-inl.h"

namespace fathom::test::error_units_test {

using vm::HWY_NAMESPACE::length_of;

// std::hypot(0.1, 0.1) was 0x1.21a1851ff630ap-3 on x86-64 and 0x1.21a1851ff630bp-3 on AArch64, where glibc fuses
// multiply-adds, so bounds of slopes differed in the last bit.
TEST_CASE("error units: lengths have the same bits on every processor", "[number][slope]") {
  CHECK(length_of(0.1, 0.1) == 0x1.21a1851ff630bp-3);
  CHECK(length_of(0.1, 1.5) == 0x1.80da360d9e625p+0);
  CHECK(length_of(3, 4) == 5);
}

TEST_CASE("error units: lengths are bounds where squares are too small or too large", "[number][slope]") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  CHECK(length_of(0, 0) == 0);
  CHECK(length_of(1e-200, 1e-200) >= 1.5e-200);
  CHECK(length_of(0x1p-401, 0x1p-401) >= 0x1.6ap-401);
  CHECK(length_of(1e200, 1) == kInfinity);
  CHECK_FALSE(length_of(0, std::numeric_limits<double>::quiet_NaN()) >= 0);
}

}  // namespace fathom::test::error_units_test
