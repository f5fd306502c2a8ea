// Escapes any text so that it fits on one line: control characters and backslashes as JSON writes them.
// Tested by: tests/vm/encoding/assemble_test.cpp
#pragma once

#include <string>
#include <string_view>

namespace fathom::vm {

// Escapes `text`. Bytes that are not UTF-8 stay unchanged.
std::string escape(std::string_view text);

// Escapes `text`, including quotes in it, and puts it between quotes.
std::string quote(std::string_view text);
// Returns the number of bytes of the quoted text that begins `line`, including both quotes, or 0 when the closing
// quote is missing.
std::size_t quoted_length(std::string_view line);

// Appends the unescaped `text`, a result of escape() or the inside of a result of quote(), to `out`. Returns false on
// a backslash that neither function would write.
bool unescape(std::string_view text, std::string& out);

}  // namespace fathom::vm
