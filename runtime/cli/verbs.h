// The table of the program's verbs, shared by `fathom --help`, the dispatch, did-you-mean, completion and the manual.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "runtime/cli/options/option_table.h"
#include "runtime/cli/options/streams.h"

namespace fathom::cli {

// Each function takes the arguments after the verb and returns an ExitCode.
int run_render(std::span<const std::string> args, const Streams& streams);
int run_view(std::span<const std::string> args, const Streams& streams);
int run_report(std::span<const std::string> args, const Streams& streams);
int run_check(std::span<const std::string> args, const Streams& streams);
int run_dump(std::span<const std::string> args, const Streams& streams);
int run_compile(std::span<const std::string> args, const Streams& streams);
int run_asm(std::span<const std::string> args, const Streams& streams);
int run_eval(std::span<const std::string> args, const Streams& streams);
int run_slice(std::span<const std::string> args, const Streams& streams);
int run_mesh(std::span<const std::string> args, const Streams& streams);
int run_tonemap(std::span<const std::string> args, const Streams& streams);
int run_plan(std::span<const std::string> args, const Streams& streams);
int run_merge(std::span<const std::string> args, const Streams& streams);
int run_diff(std::span<const std::string> args, const Streams& streams);
int run_chart(std::span<const std::string> args, const Streams& streams);
int run_emit(std::span<const std::string> args, const Streams& streams);
int run_import(std::span<const std::string> args, const Streams& streams);
int run_convert(std::span<const std::string> args, const Streams& streams);
int run_fmt(std::span<const std::string> args, const Streams& streams);
int run_explain(std::span<const std::string> args, const Streams& streams);
int run_schema(std::span<const std::string> args, const Streams& streams);
int run_completion(std::span<const std::string> args, const Streams& streams);
int run_man(std::span<const std::string> args, const Streams& streams);

struct Verb {
  std::string_view name;
  std::string_view arguments, summary;
  int (*run)(std::span<const std::string> args, const Streams& streams);
};

inline constexpr std::array kVerbs = {
    Verb{"render", "scene.fathom -o out.png", "renders the scene to image files", run_render},
    Verb{"view", "scene.fathom", "shows the scene in a browser while it is written", run_view},
    Verb{"report", "scene.fathom -o report.html", "writes a page about the scene, to be shared", run_report},
    Verb{"check", "scene.fathom", "prints errors, warnings and how exact the scene is", run_check},
    Verb{"dump", "scene.fathom", "prints the compiled scene", run_dump},
    Verb{"compile", "scene.fathom -o scene.fbc", "compiles the scene to a file", run_compile},
    Verb{"asm", "listing.txt -o scene.fbc", "assembles a listing to a compiled scene", run_asm},
    Verb{"eval", "scene.fathom --at 0,1,0", "prints distances and gradients at points", run_eval},
    Verb{"slice", "scene.fathom -o out.png", "draws the field on a plane", run_slice},
    Verb{"mesh", "scene.fathom -o part.stl", "writes the scene as a closed triangle mesh", run_mesh},
    Verb{"tonemap", "in.exr -o out.png", "converts a render's numbers to a picture", run_tonemap},
    Verb{"plan", "scene.fathom -o plan.json", "cuts a render into units for many machines", run_plan},
    Verb{"merge", "a.film b.film -o out.png", "adds up renders of parts of a picture", run_merge},
    Verb{"diff", "out.png reference.png", "compares two pictures", run_diff},
    Verb{"chart", "[scene.fathom] -o folder", "charts speed against accuracy", run_chart},
    Verb{"emit", "cpp scene.fathom -o scene.h", "writes the field as C++ or GLSL", run_emit},
    Verb{"import", "model.vm -o scene.json", "writes a model of another format as a scene file", run_import},
    Verb{"convert", "scene.json -o scene.fathom", "writes a JSON scene as text, or a text as JSON", run_convert},
    Verb{"fmt", "scene.fathom", "lays out a text: blanks and indentation", run_fmt},
    Verb{"explain", "E0311", "says what the code of an error means", run_explain},
    Verb{"schema", "", "prints the JSON Schema of scene files", run_schema},
    Verb{"completion", "bash", "prints the completion script of a shell", run_completion},
    Verb{"man", "", "prints the manual page", run_man},
};

// Returns an example of the verb's usage: "fathom render scene.fathom -o out.png".
inline std::string usage_of(const Verb& verb) {
  std::string usage = "fathom " + std::string(verb.name);
  return verb.arguments.empty() ? usage : usage + ' ' + std::string(verb.arguments);
}

// Returns the options of the verb `name`, which must exist.
OptionTable option_table(std::string_view name);

}  // namespace fathom::cli
