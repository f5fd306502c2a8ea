// Help texts for people, wrapped to the terminal's width.
// Tested by: tests/runtime/cli/options/cli_help_test.cpp
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/cli/options/option_table.h"

namespace fathom::cli {

// Returns the variable COLUMNS, or else the width of the terminal on standard output, or else 80, clamped to 40 to
// 120.
int terminal_columns();

// Breaks the text at blanks into lines of at most `width` characters. A longer word gets a line of its own.
std::vector<std::string> wrap(std::string_view text, int width);

// Wraps the text into lines indented by `indent`.
std::string paragraph(std::string_view text, int indent, int columns);

// Formats `name` and, from column `indent` on, `doc`. If `name` is too long, or if too few columns are left for
// `doc`, each of the two has lines of its own.
std::string hanging(std::string_view name, std::string_view doc, int indent, int columns);

// Returns the help of a verb.
std::string help_text(const OptionTable& table, int columns);

}  // namespace fathom::cli
