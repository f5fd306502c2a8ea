// Makes untrusted text safe to send to a terminal.
// Tested by: tests/vm/encoding/printable_test.cpp
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace fathom::vm {

// Returns the number of bytes of the UTF-8 character that begins `text`, or 0 when `text` begins with none (RFC 3629;
// overlong forms and surrogates are not UTF-8). `text` is not empty.
std::size_t character_length(std::string_view text);
// Returns the same number, but 0 for a hidden character.
std::size_t printable_length(std::string_view text);

// Returns the code of a character of at most three bytes that a reader cannot see as it is: control characters
// (Unicode's category Cc), those that reorder text (Source: N. Boucher, R. Anderson, Trojan Source: Invisible
// Vulnerabilities, 2021), byte order marks, and others without width or that break lines. Returns nothing for others.
std::optional<char32_t> hidden_code(std::string_view character);

bool is_utf8(std::string_view text);

// Replaces control characters, byte by byte, and bytes that are not UTF-8 with U+FFFD, and other hidden characters as
// JSON does: \u202e. Line breaks stay.
std::string printable(std::string_view text);

// Like printable(), for data: tabs stay too, and control characters are written as in JSON, too: \u0085.
std::string escape_controls(std::string_view text);

}  // namespace fathom::vm
