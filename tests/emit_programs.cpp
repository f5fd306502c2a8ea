// Writes tests/support/emitted_programs.h as source code that is compiled into the tests:
//
//     emit_programs cpp FILE     one header: namespaces, and a table kEmittedCpp of their functions
//     emit_programs glsl FILE    the same from GLSL, compiled as C++ with GLM: a table kEmittedGlsl
#include <fmt/format.h>

#include <fstream>
#include <regex>
#include <string>
#include <string_view>

#include "compiler/emit/emit.h"
#include "tests/support/emitted_programs.h"

namespace fathom::test {
namespace {

std::string cpp_header() {
  std::string text =
      "namespace emitted {\n"
      "struct Program {\n  const char* name;\n  float (*in_float)(float, float, float);\n"
      "  double (*in_double)(double, double, double);\n};\n}\n";
  std::string table;
  for (const EmittedProgram& program : emitted_programs()) {
    text += compiler::emit_cpp(program.scene, "emitted::" + program.name);
    table += fmt::format("    {{\"{0}\", emitted::{0}::distance<float>, emitted::{0}::distance<double>}},\n",
                         program.name);
  }
  return text + "inline constexpr emitted::Program kEmittedCpp[] = {\n" + table + "};\n";
}

// Returns the text with its array of rows as C++ has it.
std::string with_cpp_arrays(const std::string& text) {
  static const std::regex array(R"(= float\[\d+\]\(([^)]*)\);)");
  return std::regex_replace(text, array, "= {$1};");
}

std::string glsl_header() {
  std::string text =
      "namespace emitted_glsl {\nusing namespace glm;\n"
      "struct Program {\n  const char* name;\n  float (*distance)(vec3);\n  int (*surface)(vec3);\n};\n";
  std::string table;
  for (const EmittedProgram& program : emitted_programs()) {
    text += with_cpp_arrays(compiler::emit_glsl(program.scene, program.name, true));
    table += fmt::format("    {{\"{0}\", emitted_glsl::{0}_distance, emitted_glsl::{0}_surface}},\n", program.name);
  }
  return text + "}\ninline constexpr emitted_glsl::Program kEmittedGlsl[] = {\n" + table + "};\n";
}

}  // namespace
}  // namespace fathom::test

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ofstream file(argv[2]);
  file << (argv[1] == std::string_view("cpp") ? fathom::test::cpp_header() : fathom::test::glsl_header());
  return file ? 0 : 1;
}
