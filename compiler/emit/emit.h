// A scene's distance function as source code of another language, for use without Fathom: one call an instruction,
// the functions those call beside it. Every opcode's formula is recorded from its one meaning (vm/record/record.h).
//
// The function takes places of the scene, scene units, and gives distances in scene units. The text grows with the
// program and with nothing else. Surfaces and materials are not in it. Tested by: tests/compiler/emit/emit_test.cpp,
// tests/compiler/emitted_scenes_test.cpp
#pragma once

#include <string>

#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// A C++17 header of the standard library alone: `template <class T> T distance(T x, T y, T z)` in `name_space`, an
// identifier. T is float, double or lanes of either; the head of the text says what such a type must supply. With
// contraction off (-ffp-contract=off) it gives the machine's bits.
std::string emit_cpp(const CompiledScene& scene, const std::string& name_space);

// GLSL ES 3.00 and GLSL 3.30 alike, without #version, precision or main: `float NAME_distance(vec3 p)`, all its
// functions named NAME_something.
std::string emit_glsl(const CompiledScene& scene, const std::string& name);

// What is wrong with a name for these, or nothing.
std::string problem_with_namespace(std::string_view name);
std::string problem_with_glsl_name(std::string_view name);

}  // namespace fathom::compiler
