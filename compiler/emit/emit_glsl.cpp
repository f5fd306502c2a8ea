#include <fmt/format.h>

#include "compiler/emit/emit.h"
#include "compiler/emit/print_program.h"

namespace fathom::compiler {
namespace {

// {0}: the scene, {1}: name.
constexpr std::string_view kGlslHead = R"(// {0}
//
//     float {1}_distance(vec3 p)
//
// The signed distance of the place p, in the units of the scene. GLSL ES 3.00 (with precision highp float) and GLSL
// 3.30 alike, to be pasted before what calls it; all its names begin with {1}_.

)";

}  // namespace

std::string emit_glsl(const CompiledScene& scene, const std::string& name) {
  Language language = kGlsl;
  language.prefix = name + '_';
  FunctionLibrary functions(language);
  const std::string body = print_program(language, scene.distance, scene.origin, functions);
  return fmt::format(fmt::runtime(kGlslHead), describe(scene), name) + functions.text() +
         fmt::format("\nfloat {}_distance(vec3 p) {{\n{}}}\n", name, body);
}

}  // namespace fathom::compiler
