// fathom check: every error and warning of a scene, and a short report of what it compiles to. No pixels.
// Tested by: tests/runtime/cli_test.cpp
#include <fmt/format.h>

#include <limits>
#include <ostream>

#include "runtime/cli/scene_file.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr const char* kExamples =
    "fathom check scene.json\n"
    "fathom check --error-format short scene.json   # one line an error, for editors";

std::string describe(std::string_view name, const vm::VerifiedProgram& program) {
  return fmt::format("  {} program: {}, {}, stacks of {} and {}, about {} a point\n", name,
                     count_of(program.instructions(), "instruction"),
                     count_of(program.program().words.size(), "word"), count_of(program.max_values(), "value"),
                     count_of(program.max_points(), "point"), count_of(program.cost(), "multiply-add"));
}

// A line each, as -D takes them.
std::string describe(const std::vector<compiler::Parameter>& parameters) {
  std::string out;
  for (const compiler::Parameter& parameter : parameters) {
    out += fmt::format("  -D {}={}", parameter.name, parameter.value);
    if (parameter.min > -kInfinity || parameter.max < kInfinity) {
      out += fmt::format("  [{}, {}]", parameter.min, parameter.max);
    }
    out += (parameter.doc.empty() ? "" : "  " + parameter.doc) + "\n";
  }
  return out;
}

std::string report(const compiler::CompiledScene& scene) {
  return fmt::format("{}: no errors\n  {}\n", scene.source.name(), scene.summary) +
         describe("distance", scene.distance) + describe("surface", scene.surface) +
         fmt::format("  {}, {}\n", count_of(scene.materials.size(), "material"),
                     count_of(scene.surfaces.size(), "surface")) +
         describe(scene.parameters);
}

}  // namespace

int run_check(std::span<const std::string> args, const Streams& streams) {
  SceneArguments scene_arguments;
  Arguments arguments("check", "Prints every error and warning of a scene and a short report; renders nothing.",
                      kExamples);
  add_scene_arguments(arguments, scene_arguments);
  if (const auto code = arguments.parse(args, streams)) return *code;

  auto source = read_scene(scene_arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  const auto scene = compile_scene(std::get<compiler::Source>(std::move(source)), scene_arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&scene)) return *code == kBadScene ? kFoundProblems : *code;
  streams.out << report(std::get<compiler::CompiledScene>(scene));
  return kDone;
}

}  // namespace fathom::cli
