// Any text on one line: control characters and backslashes as JSON writes them.
// Tested by: tests/vm/encoding/assemble_test.cpp
#pragma once

#include <string>
#include <string_view>

namespace fathom::vm {

// What is no UTF-8 stays as it is.
std::string escape(std::string_view text);

// The same between quotes, with those in it escaped, too.
std::string quote(std::string_view text);
// How many bytes of a line that begins with a quote belong to the quoted text; 0 when it does not end.
std::size_t quoted_length(std::string_view line);

// The opposite of escape() and of what stands between the quotes, added to `out`; false when there is a backslash
// that neither would write.
bool unescape(std::string_view text, std::string& out);

}  // namespace fathom::vm
