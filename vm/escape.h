// Any text on one line: control characters and backslashes as JSON writes them.
// Tested by: tests/vm/assemble_test.cpp
#pragma once

#include <string>
#include <string_view>

namespace fathom::vm {

// What is no UTF-8 stays as it is.
std::string escape(std::string_view text);

// The opposite, added to `out`; false when there is a backslash that escape() would not write.
bool unescape(std::string_view text, std::string& out);

}  // namespace fathom::vm
