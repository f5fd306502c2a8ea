#include <fmt/format.h>

#include "compiler/emit/emit.h"
#include "compiler/emit/print_program.h"

namespace fathom::compiler {
namespace {

// {0}: the scene, {1}: name, {2}: the function of surfaces, {3}: what it returns.
constexpr std::string_view kGlslHead = R"(// {0}
//
//     float {1}_distance(vec3 p)
{2}//
// The signed distance of the place p, in the units of the scene. GLSL ES 3.00 (with precision highp float) and GLSL
// 3.30 alike, to be pasted before what calls it; all its names begin with {1}_.
{3}
)";

}  // namespace

std::string emit_glsl(const CompiledScene& scene, const std::string& name, bool surfaces) {
  Language language = kGlsl;
  language.prefix = name + '_';
  FunctionLibrary functions(language);
  const auto function = [&](std::string_view head, const vm::VerifiedProgram& program, Result result) {
    return fmt::format("\n{} {{\n{}}}\n", head, print_program(language, program, scene.origin, functions, result));
  };
  const std::string distance_head = fmt::format("float {}_distance(vec3 p)", name);
  const std::string surface_head = fmt::format("int {}_surface(vec3 p)", name);
  std::string bodies = function(distance_head, scene.distance, Result::Distance);
  if (surfaces) bodies += function(surface_head, scene.surface, Result::Surface);
  const std::string declared = surfaces ? "//     " + surface_head + '\n' : "";
  const std::string listed =
      surfaces ? "//\n// The number of the surface to which the distance belongs:\n//\n" + list_surfaces(scene) : "";
  return fmt::format(fmt::runtime(kGlslHead), describe(scene), name, declared, listed) + functions.text() + bodies;
}

}  // namespace fathom::compiler
