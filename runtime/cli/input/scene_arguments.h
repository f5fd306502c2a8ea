// The options that every verb with a scene has, as data: its file, values for its parameters, limits; and messages
// about the scene as a whole, in the form that --error-format says.
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
  std::optional<std::string> root = std::nullopt;  // of the files that the scene may import; its folder
  bool count_warnings = false;                     // say how many there are, even where there is no error
  // Called with the path of each file that the scene imports, before it is read.
  std::function<void(const std::string& path)> on_import = nullptr;
  // Adds warnings that only the renderer's own tables tell.
  std::function<void(const compiler::CompiledScene&, compiler::Diagnostics&)> inspect = nullptr;
};

// The positional argument, --define, --limit and --error-format. A scene that is not `required` has an empty path
// when none was given.
void add_scene_arguments(Arguments& arguments, SceneArguments& scene, bool required = true);
// The same for a verb that takes several scenes, one after the other.
void add_scene_arguments(Arguments& arguments, SceneArguments& scene, std::vector<std::string>& paths);

// The options --define, --limit and --error-format alone, for who reads no scene, or has it already.
void add_define_option(Arguments& arguments, SceneArguments& scene);
void add_error_format_option(Arguments& arguments, SceneArguments& scene);
void add_limit_option(Arguments& arguments, compiler::Limits& limits);

// `code`, after a message in the form that --error-format says.
ExitCode fail_about(const SceneArguments& arguments, ExitCode code, const std::string& message, const Help& help,
                    const Streams& streams);

// `code`, after the error E0701 that is about a compiled scene or a listing as a whole. `error_format` is a
// compiler::ErrorFormat.
ExitCode fail_whole(const std::string& path, const std::string& reason, const std::string& remedy, int error_format,
                    const Streams& streams, ExitCode code = kBadScene);

// A Setter for the name of a pass, or "graph" for "before the first pass".
Setter pass_name(std::optional<std::string>& target);

}  // namespace fathom::cli
