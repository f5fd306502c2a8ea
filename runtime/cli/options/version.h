// The program's version: that of project() in CMakeLists.txt, which tests/runtime/cli/cli_test.cpp compares it with.
#pragma once

#include <string_view>

namespace fathom::cli {

inline constexpr std::string_view kVersion = "0.1.0";

// The commit the program was built from, with `+` when files had changed since CMake last looked; empty outside a
// repository. Defined in a file that CMake makes.
extern const std::string_view kCommit;

}  // namespace fathom::cli
