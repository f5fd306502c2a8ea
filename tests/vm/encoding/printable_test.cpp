#include "vm/encoding/printable.h"

#include "tests/support/catch.h"

namespace fathom::vm::printable_test {

TEST_CASE("printable: what is text stays, and line breaks", "[encoding]") {
  for (const char* text : {"", "a ball\nof \u00E9, \u20AC and \U0001F600", "\u00A0", "\uFFFD"}) {
    CHECK(printable(text) == text);
  }
}

TEST_CASE("printable: neither commands to a terminal nor bytes that are no text come through", "[encoding]") {
  CHECK(printable("\x1b[31mred\x7f\t") == "\uFFFD[31mred\uFFFD\uFFFD");
  CHECK(printable("\u009b31m") == "\uFFFD\uFFFD31m");
  CHECK(printable("\xff\x80 \xe2\x82") == "\uFFFD\uFFFD \uFFFD\uFFFD");
  CHECK(printable(std::string_view("\0a", 2)) == "\uFFFDa");
}

// Regression: overlong forms and surrogates passed through, although no UTF-8 decoder accepts them.
TEST_CASE("printable: what comes through is UTF-8", "[encoding]") {
  CHECK(printable("\xc0\x80 \xc1\xbf") == "\uFFFD\uFFFD \uFFFD\uFFFD");
  CHECK(printable("\xe0\x9f\xbf") == "\uFFFD\uFFFD\uFFFD");
  CHECK(printable("\xed\xa0\x80") == "\uFFFD\uFFFD\uFFFD");
  CHECK(printable("\xf0\x8f\xbf\xbf") == "\uFFFD\uFFFD\uFFFD\uFFFD");
  CHECK(printable("\xf4\x90\x80\x80") == "\uFFFD\uFFFD\uFFFD\uFFFD");
  for (const char* text : {"\u0800", "\ud7ff", "\ue000", "\U00010000", "\U0010ffff"}) CHECK(printable(text) == text);
}

// They reordered or hid parts of messages: a quoted point with an invisible mark looked right.
TEST_CASE("printable: characters that reorder text or have no width are escaped", "[encoding]") {
  CHECK(printable("\uFEFF1 2 3") == "\\ufeff1 2 3");
  CHECK(printable("a\u202Eb\u2066c\u200Fd\u061Ce") == "a\\u202eb\\u2066c\\u200fd\\u061ce");
  CHECK(escape_controls("\u2028\u200B\u2060") == "\\u2028\\u200b\\u2060");
  CHECK(printable_length("\u202E") == 0);
  CHECK(printable_length("\u202F") == 3);
  CHECK(printable("\u200C\u200D") == "\u200C\u200D");  // letters of some scripts are joined by them
}

TEST_CASE("printable: data keep their controls as JSON writes them", "[encoding]") {
  CHECK(escape_controls("a\tb\n\u009b31m \x1b\x7f \u00e9") == "a\tb\n\\u009b31m \\u001b\\u007f \u00e9");
  CHECK(escape_controls("\xff\xc0\x80") == "\uFFFD\uFFFD\uFFFD");
}

}  // namespace fathom::vm::printable_test
