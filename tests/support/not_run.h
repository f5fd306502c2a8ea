// A test case that cannot run on a machine says so, instead of passing in silence.
#pragma once

#include <string>

#include "tests/support/catch.h"

namespace fathom::test {

// Reports "not run: zsh is missing" with the case's name. Catch2 3 ends the case and counts it as skipped. Catch2 2
// knows no skipped cases, so the report is a warning and the caller returns:
//
//     if (!has_program("zsh")) return not_run("zsh is missing");
inline void not_run(const std::string& reason) {
#ifdef SKIP
  SKIP("not run: " << reason);
#else
  WARN("not run: " << reason);
#endif
}

}  // namespace fathom::test
