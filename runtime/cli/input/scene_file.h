// The scene every verb starts from: reading its file, compiling it, printing what is wrong with it.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <optional>
#include <variant>

#include "compiler/artefact/load.h"
#include "compiler/compile.h"
#include "compiler/frontend/animation.h"
#include "runtime/cli/input/scene_arguments.h"
#include "runtime/cli/options/streams.h"

namespace fathom::cli {

// A scene as a file has it.
struct SceneInput {
  compiler::Source source;                      // its text; empty when a file of compiled programs came without
  std::optional<compiler::StoredScene> stored;  // of such a file
};

// The scene's text and programs, or the exit code after a message.
std::variant<SceneInput, ExitCode> read_scene(const SceneArguments& arguments, const Streams& streams);

// The text alone, also of a compiled file whose programs are for another machine.
struct SceneText {
  compiler::Source source;
  bool compiled = false;  // it came in such a file
};
// What the file was compiled with comes before the command line's definitions.
std::variant<SceneText, ExitCode> read_scene_text(SceneArguments& arguments, const Streams& streams);

// Compiles and prints the diagnostics, warnings too. When there were errors, kBadScene, or kUsage for values that the
// scene's parameters cannot have. The programs of a compiled file that are not those of its text, or came without,
// are taken as they are, unproved and with a warning, unless `options` ask for what lies between text and programs.
std::variant<compiler::CompiledScene, ExitCode> compile_scene(SceneInput input, const SceneArguments& arguments,
                                                              const Streams& streams,
                                                              compiler::CompileOptions options = {});

// What the scene says of its animation, or the exit code after a message. The input has what the scene imports, then,
// so that all its frames are of the same files.
std::variant<compiler::Animation, ExitCode> read_animation(SceneInput& input, const SceneArguments& arguments,
                                                           const Streams& streams);

// A stored scene as its file has it, places and names of instructions too, but with proofs or without, as they are.
compiler::CompiledScene proved_or_claimed(const SceneInput& input);

}  // namespace fathom::cli
