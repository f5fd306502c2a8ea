// What SVG and HTML texts are made of. All of it is the same in every locale.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fathom::runtime {

// The text with what markup gives a meaning (& < > " ') spelled out, fit for content and for quoted attributes.
// Characters that XML has no spelling for, controls but tab and line ends, become U+FFFD.
std::string escape_markup(std::string_view text);

// A number for coordinates and lengths: two decimals at most, none it does not need.
std::string coordinate(double number);

// A number for people, to three digits: `0.0017`, `1140`, `2.5e-6`; `?` for what was not measured.
std::string readable(double number);

// A count with its digits in groups of three: `50 000`; the spaces do not break.
std::string grouped(std::int64_t count);

// readable() with an exponent always: `1e-3`, `2.5e-6`.
std::string scientific(double number);

}  // namespace fathom::runtime
