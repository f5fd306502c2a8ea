// Reader for the property `params` of a scene. Values given by the caller override those in the scene.
// Tested by: tests/compiler/frontend/records/scene_numbers_test.cpp, tests/golden/diagnostics (E0407, E0408, E05xx, W0404)
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Parameter values by name, from the command line. The last value of a name counts.
using Definitions = std::vector<std::pair<std::string, double>>;

// Returns the scene's parameters. Reports all errors in them and in `definitions`. `params` may be null.
Scope read_parameters(const syntax::Value* params, const Definitions& definitions, const Limits& limits,
                      Diagnostics& diagnostics);

// Declares one parameter and reads its value. Call check_definitions() after the last parameter: it reports
// definitions of unknown parameters.
const Scope::Entry& read_parameter(const syntax::Property& property, const Definitions& definitions, Scope& scope,
                                   Diagnostics& diagnostics);
void check_definitions(const Definitions& definitions, const Scope& scope, Diagnostics& diagnostics);

void warn_of_unused(const Scope& scope, Diagnostics& diagnostics);

// Parameters that make a scene animated if it declares them (compiler/frontend/animation.h).
inline constexpr std::string_view kTimeParameter = "time", kFrameParameter = "frame";

bool declares(const Scope& parameters, std::string_view name);

}  // namespace fathom::compiler
