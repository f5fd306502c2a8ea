// fathom emit: the scene's distance function as C++ or GLSL, or a page that draws it.
// Tested by: tests/runtime/cli/cli_emit_test.cpp
#include "compiler/emit/emit.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/verbs.h"
#include "runtime/live/live_page.h"

namespace fathom::cli {
namespace {

constexpr const char* kEmitExamples =
    "fathom emit cpp scene.fathom -o scene.h       # fathom_scene::distance(x, y, z)\n"
    "fathom emit cpp scene.fathom --namespace wall # wall::distance(x, y, z)\n"
    "fathom emit glsl scene.fathom > scene.glsl    # scene_distance(p)\n"
    "fathom emit glsl scene.fathom --name wall     # wall_distance(p)\n"
    "fathom emit glsl scene.fathom --surfaces      # scene_surface(p), too\n"
    "fathom emit html scene.fathom -o scene.html   # open it in a browser\n"
    "\n"
    "The C++ function is a template; the head of the file lists what a type needs apart from float and double.\n"
    "Objects that differ in numbers alone become a loop over an array. A compiler takes minutes for thousands of\n"
    "different objects, and a graphics driver may refuse them, or such an array.";

enum Language { kCpp, kGlsl, kHtml };

struct EmitRequest {
  int language = kCpp;
  SceneArguments scene;
  std::optional<std::string> output, name_space, name;
  bool surfaces = false;
};

// Makes a Setter that accepts a name unless `problem_with` returns a problem.
Setter identifier(std::string (*problem_with)(std::string_view), std::optional<std::string>& target) {
  return [problem_with, &target](std::string_view text) -> OptionResult {
    if (std::string problem = problem_with(text); !problem.empty()) {
      return OptionError{fmt::format("`{}` cannot be a name there", text), std::move(problem)};
    }
    target = text;
    return std::nullopt;
  };
}

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, EmitRequest& request) {
  Arguments arguments("emit", "Writes the scene's distance function as C++ or GLSL, or a page that draws it.",
                      kEmitExamples);
  std::string language;
  arguments.positional("language",
                       "cpp: a C++17 header; glsl: functions for a shader; html: a page that draws the scene live",
                       language, true, "LANGUAGE", {"cpp", "glsl", "html"});
  add_scene_arguments(arguments, request.scene);
  arguments.option("-o,--output", "FILE", "File to write (standard output)", any_text(request.output));
  arguments.option("--namespace", "NAME", "cpp: namespace of the function (fathom_scene)",
                   identifier(compiler::problem_with_namespace, request.name_space));
  arguments.option("--name", "NAME", "glsl: prefix of all names (scene)",
                   identifier(compiler::problem_with_glsl_name, request.name));
  arguments.flag("--surfaces", "glsl: also print a function that returns the surface at a point", request.surfaces);
  if (const auto code = arguments.parse(args, streams)) return code;
  if (const OptionResult wrong = one_of({"cpp", "glsl", "html"}, request.language)(language)) {
    return fail(streams, kUsage, fmt::format("unknown language: {}", wrong->problem),
                {wrong->help.empty() ? "there are cpp, glsl and html" : wrong->help});
  }
  if (request.language != kCpp && request.name_space) {
    return fail(streams, kUsage, "--namespace is about C++", {"use --name for GLSL"});
  }
  if (request.language != kGlsl && request.name) {
    return fail(streams, kUsage, "--name is about GLSL", {"use --namespace for C++"});
  }
  if (request.language != kGlsl && request.surfaces) {
    return fail(streams, kUsage, "--surfaces is about GLSL", {"leave it out, or emit glsl"});
  }
  return check_text_output(request.output, streams);
}

std::string text_of(const compiler::CompiledScene& scene, const EmitRequest& request) {
  switch (request.language) {
    case kGlsl:
      return compiler::emit_glsl(scene, request.name.value_or("scene"), request.surfaces);
    case kHtml:
      return runtime::live_page(scene);
    default:
      return compiler::emit_cpp(scene, request.name_space.value_or("fathom_scene"));
  }
}

}  // namespace

int run_emit(std::span<const std::string> args, const Streams& streams) {
  EmitRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  const auto compiled = compile_scene(std::get<SceneInput>(std::move(source)), request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  const auto& scene = std::get<compiler::CompiledScene>(compiled);
  return write_text_output(text_of(scene, request), request.output, streams);
}

}  // namespace fathom::cli
