// The program's version, equal to that of project() in CMakeLists.txt (checked by tests/runtime/cli/cli_test.cpp).
#pragma once

#include <string_view>

namespace fathom::cli {

inline constexpr std::string_view kVersion = "0.1.0";

// Commit from which the program was built, followed by `+` if the last run of CMake found modified files. Empty
// outside a repository. Defined in a file that CMake generates.
extern const std::string_view kCommit;

#ifdef __clang__
inline constexpr std::string_view kClang = "clang " __clang_version__;  // may end with a space
inline constexpr std::string_view kCompiler = kClang.substr(0, kClang.find_last_not_of(' ') + 1);
#else
inline constexpr std::string_view kCompiler = "g++ " __VERSION__;
#endif

}  // namespace fathom::cli
