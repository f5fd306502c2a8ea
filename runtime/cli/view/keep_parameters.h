// Writes values of parameters into the text of a scene, as their defaults.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#pragma once

#include <string>
#include <variant>

#include "compiler/frontend/records/parameters.h"
#include "compiler/source/source.h"

namespace fathom::cli {

struct KeepError {
  std::string reason;
};

// Returns the text with the values in place of the numbers that it has for these parameters; all else stays as it
// is. The text must be a scene in text form or JSON, without errors. A default that is a formula is not replaced:
// the result is then an error.
std::variant<std::string, KeepError> keep_parameters(const compiler::Source& source,
                                                     const compiler::Definitions& values);

}  // namespace fathom::cli
