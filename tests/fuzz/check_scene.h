// What must hold of every text that the compiler is given, in whatever format.
#pragma once

#include <optional>
#include <string>

#include "compiler/compile.h"

namespace fathom::fuzz {

// Compiles the text with all that can be asked for; every message prints in every format; there is a scene exactly
// when there is no error; what was read can be written as a scene file, and read again as the same; of a text when it
// is a scene. Of a scene, every program is checked. Throws BrokenPromise.
void check_scene(const std::string& text);

// Of a scene that came compiled, from anyone: every program gives the same bits wherever it runs, can be read as an
// expression or not, and the scene can be drawn. Throws BrokenPromise.
void check_stored(const compiler::CompiledScene& scene);

}  // namespace fathom::fuzz
