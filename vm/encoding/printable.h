// Makes untrusted text safe to send to a terminal.
// Tested by: tests/vm/encoding/printable_test.cpp
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fathom::vm {

// Returns the number of bytes of the character that begins `text`, or 0 when the character is a control character
// (Unicode's category Cc) or not UTF-8 (RFC 3629; overlong forms and surrogates are not UTF-8). `text` is not empty.
std::size_t printable_length(std::string_view text);

bool is_utf8(std::string_view text);

// Replaces each byte that belongs to no printable character with U+FFFD. Line breaks stay.
std::string printable(std::string_view text);

// Like printable(), for data: tabs stay too, and control characters are written as in JSON: \u0085.
std::string escape_controls(std::string_view text);

}  // namespace fathom::vm
