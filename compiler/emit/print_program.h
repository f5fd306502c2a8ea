// Prints a program as the body of a function: one named value per instruction, in the program's order. A body of
// instructions that repeats becomes a loop over rows of numbers.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "compiler/emit/function_library.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// The result of a printed function: the distance, or the number of the surface to which it belongs, an int that is
// its index in CompiledScene::surfaces.
enum class Result { Distance, Surface };

// Returns the lines between the braces of a function of the point `p`, in scene coordinates. `origin` is the
// program's zero in scene coordinates. Adds the functions that the lines call to `functions`, and the rows of loops
// to `rows`: the lines read number n by a function PREFIXrow(n). Without `rows` there are no loops.
std::string print_program(const Language& language, const vm::VerifiedProgram& program, const glm::dvec3& origin,
                          FunctionLibrary& functions, Result result, std::vector<double>* rows = nullptr);

// Describes the scene's file and its field, for a comment of one line.
std::string describe(const CompiledScene& scene);
// Lists the numbers of rows, separated by commas, in lines.
std::string list_rows(const Language& language, const std::vector<double>& rows);
// Lists the numbers and names of the scene's surfaces, for comments of a line each.
std::string list_surfaces(const CompiledScene& scene);

}  // namespace fathom::compiler
