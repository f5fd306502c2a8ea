// A program as the body of a function: one named value an instruction, in the program's order.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "compiler/emit/function_library.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// The lines between the braces of a function of the point `p`, a place of the scene whose `origin` is the program's
// zero. The functions it calls are added to `functions`.
std::string print_program(const Language& language, const vm::VerifiedProgram& program, const glm::dvec3& origin,
                          FunctionLibrary& functions);

// The scene's file and what is known of its field, for a comment of one line.
std::string describe(const CompiledScene& scene);

}  // namespace fathom::compiler
