// Promises that hold for every text that the compiler reads, in any format.
#pragma once

#include <optional>
#include <string>

#include "compiler/compile.h"

namespace fathom::fuzz {

// Compiles the text with all options. Every message prints in every format. There is a scene if and only if there is
// no error. A scene that was read writes as a scene file and reads back as the same scene (for texts: if they
// compile). Checks every program of the scene. Throws BrokenPromise.
void check_scene(const std::string& text);

// Checks a compiled scene of unknown origin: every program gives the same bits on every instruction set, is read as
// an expression or refused, and the scene renders. Throws BrokenPromise.
void check_stored(const compiler::CompiledScene& scene);

}  // namespace fathom::fuzz
