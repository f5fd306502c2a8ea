// The options common to all verbs with a scene, as data: its file, values for its parameters, limits. Also prints
// messages about the scene as a whole, in the form chosen by --error-format.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/input/cli_define_test.cpp
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compiler/frontend/records/parameters.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/streams.h"

namespace fathom::cli {

struct SceneArguments {
  std::string path;                   // "-": standard input
  int error_format = 0;               // a compiler::ErrorFormat
  compiler::Definitions definitions;  // values for the scene's parameters
  compiler::Limits limits;
  std::optional<std::string> root = std::nullopt;  // folder of permitted imports; default: the scene's
  bool count_warnings = false;                     // print the number of warnings even if there is no error
  // Called with the path of each file that the scene imports, before it is read.
  std::function<void(const std::string& path)> on_import = nullptr;
  // Adds warnings that depend on the renderer's tables.
  std::function<void(const compiler::CompiledScene&, compiler::Diagnostics&)> inspect = nullptr;
};

// Adds the positional argument, --define, --limit and --error-format. An omitted scene that is not `required` has an
// empty path.
void add_scene_arguments(Arguments& arguments, SceneArguments& scene, bool required = true);
// The same for a verb that takes several scenes and handles them one after the other.
void add_scene_arguments(Arguments& arguments, SceneArguments& scene, std::vector<std::string>& paths);

// Add --define, --error-format or --limit only, for verbs that read no scene or have it already.
void add_define_option(Arguments& arguments, SceneArguments& scene);
void add_error_format_option(Arguments& arguments, SceneArguments& scene);
void add_limit_option(Arguments& arguments, compiler::Limits& limits);

// Prints the message in the form chosen by --error-format and returns `code`.
ExitCode fail_about(const SceneArguments& arguments, ExitCode code, const std::string& message, const Help& help,
                    const Streams& streams);

// Prints the error E0701, about a compiled scene or a listing as a whole, and returns `code`. `error_format` is a
// compiler::ErrorFormat.
ExitCode fail_whole(const std::string& path, const std::string& reason, const std::string& remedy, int error_format,
                    const Streams& streams, ExitCode code = kBadScene);

// Makes a Setter for the name of a pass. "graph" stands for the state before the first pass.
Setter pass_name(std::optional<std::string>& target);

}  // namespace fathom::cli
