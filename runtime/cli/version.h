// The program's version: that of project() in CMakeLists.txt, which tests/runtime/cli_test.cpp compares it with.
#pragma once

#include <string_view>

namespace fathom::cli {

inline constexpr std::string_view kVersion = "0.1.0";

}  // namespace fathom::cli
