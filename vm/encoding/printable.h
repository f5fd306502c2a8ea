// Text from strangers as a terminal may be sent it.
// Tested by: tests/vm/encoding/printable_test.cpp
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fathom::vm {

// The bytes of the character that begins `text`, which is not empty; 0 when it is a control character (Unicode's
// category Cc) or no UTF-8 (RFC 3629: neither overlong nor a surrogate).
std::size_t printable_length(std::string_view text);

// Each byte that does not belong to such a character as U+FFFD; line breaks stay.
std::string printable(std::string_view text);

// The same for data, with tabs as they are and control characters as JSON writes them: \u0085.
std::string escape_controls(std::string_view text);

}  // namespace fathom::vm
