#include <fmt/format.h>

#include <algorithm>

#include "compiler/emit/cpp_text.h"
#include "compiler/emit/emit.h"
#include "compiler/emit/print_program.h"

namespace fathom::compiler {
namespace {

// wall::door -> WALL_DOOR_DISTANCE_H
std::string guard_of(const std::string& name_space) {
  std::string guard;
  for (const char c : name_space) {
    if (c != ':') guard += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    if (c == ':' && !guard.ends_with('_')) guard += '_';
  }
  return guard + "_DISTANCE_H";
}

}  // namespace

std::string emit_cpp(const CompiledScene& scene, const std::string& name_space) {
  FunctionLibrary functions(kCpp);
  std::vector<double> rows;
  const std::string body = print_program(kCpp, scene.distance, scene.origin, functions, Result::Distance, &rows);
  std::string text = fmt::format(fmt::runtime(kCppHead), describe(scene), name_space, guard_of(name_space));
  text += fmt::format("namespace {} {{\n\n{}", name_space, kCppPrimitives);
  for (const char* type : {"float", "double"}) text += '\n' + fmt::format(fmt::runtime(kCppScalar), type);
  text += kCppOpen;
  if (!rows.empty()) {
    text += fmt::format(
        "static constexpr double rows[] = {{\n{}}};\nstatic FATHOM_SCENE_INLINE double row(int n) {{ return "
        "rows[n]; }}\n\n",
        list_rows(kCpp, rows));
  }
  text += fmt::format("{}\nstatic FATHOM_SCENE_INLINE T distance([[maybe_unused]] vec3 p) {{\n{}}}\n}};\n",
                      functions.text(), body);
  text +=
      "\ntemplate <class T>\nFATHOM_SCENE_INLINE T distance(T x, T y, T z) {\n  return Scene<T>::distance({x, y, "
      "z});\n}\n";
  return text + fmt::format("\n}}  // namespace {}\n\n#endif\n", name_space);
}

}  // namespace fathom::compiler
