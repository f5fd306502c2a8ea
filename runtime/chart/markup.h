// Building blocks of SVG and HTML texts, independent of the locale.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fathom::runtime {

// Escapes & < > " ' for use in content and quoted attributes. Characters not allowed in XML, which are controls
// except tab and line ends, become U+FFFD.
std::string escape_markup(std::string_view text);

// Formats a coordinate or length with at most two decimals and no trailing zeros.
std::string coordinate(double number);

// Formats a number for people with three significant digits: `0.0017`, `1140`, `2.5e-6`. NaN (not measured) is `?`.
std::string readable(double number);

// Formats a count with its digits in groups of three, separated by no-break spaces: `50 000`.
std::string grouped(std::int64_t count);

// Formats like readable() but always with an exponent: `1e-3`, `2.5e-6`.
std::string scientific(double number);

}  // namespace fathom::runtime
