// Help for people, wrapped to a terminal's width.
// Tested by: tests/runtime/cli/options/cli_help_test.cpp
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/cli/options/option_table.h"

namespace fathom::cli {

// The width of the terminal that standard output is, or what the variable COLUMNS says, from 40 to 120; 80 when
// neither says.
int terminal_columns();

// The text broken at blanks into lines of `width` characters. A longer word has a line of its own.
std::vector<std::string> wrap(std::string_view text, int width);

// The text in lines that are indented by `indent`.
std::string paragraph(std::string_view text, int indent, int columns);

// `name` and, from column `indent` on, `doc`. A name that is too long has lines of its own, and so has every name
// where little room is left for `doc`.
std::string hanging(std::string_view name, std::string_view doc, int indent, int columns);

// The help of a verb.
std::string help_text(const OptionTable& table, int columns);

}  // namespace fathom::cli
