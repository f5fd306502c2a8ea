// Reads a scene's file, compiles it, and prints its errors and warnings: the first step of every verb with a scene.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <optional>
#include <variant>

#include "compiler/artefact/compiled_file.h"
#include "compiler/compile.h"
#include "compiler/frontend/animation.h"
#include "runtime/cli/input/scene_arguments.h"
#include "runtime/cli/options/streams.h"

namespace fathom::cli {

// A scene as read from its file.
struct SceneInput {
  compiler::Source source;                      // the text; empty for a compiled file without text
  std::optional<compiler::StoredScene> stored;  // set for a compiled file
};

// Returns the scene's text and programs, or the exit code after a message.
std::variant<SceneInput, ExitCode> read_scene(const SceneArguments& arguments, const Streams& streams);

// The scene's text only, also from a compiled file whose programs are for another machine.
struct SceneText {
  compiler::Source source;
  bool compiled = false;  // the text comes from a compiled file
};
// Reads the text. Definitions stored in a compiled file are inserted before the command line's.
std::variant<SceneText, ExitCode> read_scene_text(SceneArguments& arguments, const Streams& streams);

// Compiles the scene and prints all errors and warnings. After errors, returns kBadScene, or kUsage if they concern
// the command line's values for parameters. A compiled file is not compiled again: the scene is the stored one, with
// its claims, unless the command line sets parameters or `options` ask for intermediate results, both of which need
// the text. With options.lint, the programs of the text must be those of the file.
std::variant<compiler::CompiledScene, ExitCode> compile_scene(SceneInput input, const SceneArguments& arguments,
                                                              const Streams& streams,
                                                              compiler::CompileOptions options = {});

// Compiles the scene's text with all warnings. `graph` receives the graph before the first pass, which
// compiler::make_report() needs.
std::variant<compiler::CompiledScene, ExitCode> compile_checked(const SceneInput& input,
                                                                const SceneArguments& arguments,
                                                                compiler::Scene& graph, const Streams& streams,
                                                                compiler::CompileOptions options = {});

// Reads the scene's animation, or returns the exit code after a message. Also loads the scene's imports into `input`,
// so that all frames use the same files.
std::variant<compiler::Animation, ExitCode> read_animation(SceneInput& input, const SceneArguments& arguments,
                                                           const Streams& streams);

// Returns the stored scene, whose summary says which facts are claims of the file.
compiler::CompiledScene as_claimed(compiler::CompiledScene stored);

}  // namespace fathom::cli
