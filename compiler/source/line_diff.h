// The difference of two texts by lines, in the unified format of diff -u.
// Tested by: tests/compiler/source/line_diff_test.cpp
#pragma once

#include <string>
#include <string_view>

namespace fathom::compiler {

// Returns the hunks, with three unchanged lines around each change; empty when the texts are equal. The hunks mark
// the fewest lines that explain the change. If more than `limit` lines of either text lie between the first and the
// last difference, the result is one line that says so. `limit` is at most 65535.
std::string unified_diff(std::string_view before, std::string_view after, std::size_t limit = 5000);

}  // namespace fathom::compiler
