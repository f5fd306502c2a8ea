// The property `params` of a scene: its parameters, with the values that the caller gives them in place of theirs.
// Tested by: tests/compiler/frontend/records/scene_numbers_test.cpp, tests/golden/diagnostics (E0407, E0408, E05xx, W0404)
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Values for parameters by name, from the command line; the last of a name counts.
using Definitions = std::vector<std::pair<std::string, double>>;

// The scene's parameters, everything wrong with them and with `definitions` reported. `params` may be null.
Scope read_parameters(const syntax::Value* params, const Definitions& definitions, const Limits& limits,
                      Diagnostics& diagnostics);

// The same a parameter at a time: declares it and reads its value. What goes beyond all of them is checked at the
// end.
const Scope::Entry& read_parameter(const syntax::Property& property, const Definitions& definitions, Scope& scope,
                                   Diagnostics& diagnostics);
void check_definitions(const Definitions& definitions, const Scope& scope, Diagnostics& diagnostics);

void warn_of_unused(const Scope& scope, Diagnostics& diagnostics);

// Parameters that animate a scene which declares them (frontend/animation.h).
inline constexpr std::string_view kTimeParameter = "time", kFrameParameter = "frame";

bool declares(const Scope& parameters, std::string_view name);

}  // namespace fathom::compiler
