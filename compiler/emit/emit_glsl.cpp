#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

std::string distance_head(const std::string& prefix) { return fmt::format("float {}distance(vec3 p)", prefix); }
std::string surface_head(const std::string& prefix) { return fmt::format("int {}surface(vec3 p)", prefix); }

// Returns the functions NAME_distance and, with `surfaces`, NAME_surface, after those that they call.
// `loops`: with loops over arrays of numbers.
std::string print_functions(const Language& language, const CompiledScene& scene, bool surfaces, bool loops) {
  FunctionLibrary functions(language);
  std::string bodies, data;
  std::vector<double> rows;
  const auto print = [&](std::string_view head, const vm::VerifiedProgram& program, Result result) {
    bodies += fmt::format("\n{} {{\n{}}}\n", head,
                          print_program(language, program, scene.origin, functions, result, loops ? &rows : nullptr));
  };
  print(distance_head(language.prefix), scene.distance, Result::Distance);
  if (surfaces) print(surface_head(language.prefix), scene.surface, Result::Surface);
  if (!rows.empty()) {
    data = fmt::format(
        "const float {0}rows[{1}] = float[{1}](\n{2});\nfloat {0}row(int n) {{\n  return {0}rows[n];\n}}\n",
        language.prefix, rows.size(), list_rows(language, rows));
  }
  return data + functions.text() + bodies;
}

// True for numbers that are likelier to mean no translation, no rotation or no limit than to be chosen.
bool is_structural(double value) { return value == 0 || std::abs(value) == 1 || std::isinf(value); }

}  // namespace

std::string emit_glsl(const CompiledScene& scene, const std::string& name, bool surfaces) {
  Language language = kGlsl;
  language.prefix = name + '_';
  const std::string declared = surfaces ? "//     " + surface_head(language.prefix) + '\n' : "";
  const std::string listed =
      surfaces ? "//\n// The number of the surface to which the distance belongs:\n//\n" + list_surfaces(scene) : "";
  return fmt::format(fmt::runtime(kGlslHead), describe(scene), name, declared, listed) +
         print_functions(language, scene, surfaces, true);
}

GlslTemplate emit_glsl_template(const CompiledScene& scene, const std::string& name) {
  GlslTemplate result;
  Language language = kGlsl;
  language.prefix = name + '_';
  language.has_comments = false;
  language.immediate = [&](double value) {
    if (is_structural(value)) return language.literal(value);
    const std::size_t i = result.numbers.size();
    result.numbers.push_back(static_cast<float>(value));
    return fmt::format("{}_numbers[{}].{}", name, i / 4, "xyzw"[i % 4]);
  };
  result.text = print_functions(language, scene, true, false);
  if (result.numbers.size() > kMaxGlslNumbers) {
    language.immediate = language.literal;
    result = {print_functions(language, scene, true, false), {}};
  }
  result.numbers.resize((std::max<std::size_t>(1, result.numbers.size()) + 3) / 4 * 4);
  return result;
}

}  // namespace fathom::compiler
