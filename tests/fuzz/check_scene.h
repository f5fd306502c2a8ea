// What must hold of every text that the compiler is given, in whatever format.
#pragma once

#include <optional>
#include <string>

#include "compiler/compile.h"

namespace fathom::fuzz {

// Compiles the text with all that can be asked for; every message prints in every format; there is a scene exactly
// when there is no error; what was read can be written as a scene file, and read again as the same. Of a scene, every
// program is checked. Throws BrokenPromise.
void check_scene(const std::string& text);

}  // namespace fathom::fuzz
