// The difference of two texts by lines, in the unified format of diff -u.
// Tested by: tests/compiler/source/line_diff_test.cpp
#pragma once

#include <string>
#include <string_view>

namespace fathom::compiler {

// The hunks, with three lines of what stays around each change; empty when the texts are equal. The fewest lines that
// explain the change are marked, unless more than `limit` lines of either text lie between the first difference and
// the last: then a line that says so. `limit` is at most 65535.
std::string unified_diff(std::string_view before, std::string_view after, std::size_t limit = 5000);

}  // namespace fathom::compiler
