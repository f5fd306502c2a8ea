#include "vm/printable.h"

#include <catch2/catch.hpp>

namespace fathom::vm {

TEST_CASE("printable: what is text stays, and line breaks", "[vm]") {
  for (const char* text : {"", "a ball\nof \u00E9, \u20AC and \U0001F600", "\u00A0", "\uFFFD"}) {
    CHECK(printable(text) == text);
  }
}

TEST_CASE("printable: neither commands to a terminal nor bytes that are no text come through", "[vm]") {
  CHECK(printable("\x1b[31mred\x7f\t") == "\uFFFD[31mred\uFFFD\uFFFD");
  CHECK(printable("\u009b31m") == "\uFFFD\uFFFD31m");
  CHECK(printable("\xff\x80 \xe2\x82") == "\uFFFD\uFFFD \uFFFD\uFFFD");
  CHECK(printable(std::string_view("\0a", 2)) == "\uFFFDa");
}

}  // namespace fathom::vm
