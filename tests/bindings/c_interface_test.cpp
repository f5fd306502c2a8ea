// The C interface, checked by a program in C99.
#include "tests/support/catch.h"

extern "C" int check_c_interface(void);

namespace fathom::c_interface_test {

TEST_CASE("the C interface does what the C++ interface does", "[library]") {
  CHECK(check_c_interface() == 0);  // the line of tests/bindings/c_interface.c that fails
}

}  // namespace fathom::c_interface_test
