// Prints a scene's distance function as source code of another language, for use without Fathom: one call per
// instruction, and the functions called. Every opcode's formula is recorded from its only definition
// (vm/record/record.h).
//
// The function maps a point of the scene to a distance, both in scene units. The length of the text depends on the
// program alone. A body of instructions that repeats is a loop over an array of numbers. Materials are not part of the
// text.
// Tested by: tests/compiler/emit/emit_test.cpp, tests/compiler/emit/emitted_cpp_test.cpp,
// tests/compiler/emit/emitted_glsl_test.cpp
#pragma once

#include <string>
#include <vector>

#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Prints a C++17 header that needs only the standard library: `template <class T> T distance(T x, T y, T z)` in
// `name_space`, an identifier. T is float, double or a lane type of either; the head of the text states the
// requirements on lane types. With contraction off (-ffp-contract=off) the function returns the machine's bits.
std::string emit_cpp(const CompiledScene& scene, const std::string& name_space);

// Prints `float NAME_distance(vec3 p)` in both GLSL ES 3.00 and GLSL 3.30, without #version, precision or main. All
// functions of the text are named NAME_something. `surfaces`: also prints `int NAME_surface(vec3 p)`, the index in
// CompiledScene::surfaces of the surface to which the distance belongs, as vm::evaluate_surface() finds it.
std::string emit_glsl(const CompiledScene& scene, const std::string& name, bool surfaces = false);

// A scene as GLSL in which the immediates of its instructions are data, so that a renderer compiles nothing when only
// numbers change.
struct GlslTemplate {
  // The functions of emit_glsl() with surfaces, without comments, which read an array `vec4 NAME_numbers[]`. Equal
  // for scenes whose programs differ only in immediates. The text itself has the corners of outlines; immediates of
  // 0, 1 and infinity, so that a compiler simplifies what multiplies by them; and all immediates if there are more
  // than kMaxGlslNumbers.
  std::string text;
  std::vector<float> numbers;  // of the array; a multiple of four, at least four
};
// Every device has room for so many numbers in a uniform block.
inline constexpr std::size_t kMaxGlslNumbers = 4096;
GlslTemplate emit_glsl_template(const CompiledScene& scene, const std::string& name);

// Returns the problem with a name for the emitted code; empty when there is none.
std::string problem_with_namespace(std::string_view name);
std::string problem_with_glsl_name(std::string_view name);

}  // namespace fathom::compiler
