// The program's exit codes and their meanings, the only list of them, printed by `fathom --help`. Codes above 2
// follow sysexits.h, so that scripts can tell what to do next.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <array>
#include <string_view>

namespace fathom::cli {

enum ExitCode : int {
  kDone = 0,
  kFoundProblems = 1,
  kUsage = 2,
  kBadScene = 65,
  kInternal = 70,
  kIo = 74,
  kInterrupted = 75,
};

struct ExitCodeInfo {
  ExitCode code;
  std::string_view meaning;
};

inline constexpr std::array kExitCodes = {
    ExitCodeInfo{kDone, "done"},
    ExitCodeInfo{kFoundProblems,
                 "`check` found errors in the scene, or with --probe a broken constant (warnings do not count); "
                 "`diff` found more than --tol; `plan --status` found units to be rendered"},
    ExitCodeInfo{kUsage, "the command line is wrong"},
    ExitCodeInfo{kBadScene, "the scene, a list of points or a picture has errors; trying again will not help"},
    ExitCodeInfo{kInternal, "a defect of fathom, or not enough memory"},
    ExitCodeInfo{kIo, "a file could not be read or written; trying again may help"},
    ExitCodeInfo{kInterrupted, "a signal ended the render and a checkpoint was written; `--resume` goes on"},
};

}  // namespace fathom::cli
