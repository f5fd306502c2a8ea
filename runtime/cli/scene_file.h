// The scene every verb starts from: reading its file, compiling it, printing what is wrong with it.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/artefact/load.h"
#include "compiler/compile.h"
#include "compiler/frontend/animation.h"
#include "runtime/cli/arguments.h"
#include "runtime/cli/streams.h"

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

// The text of a file, or of standard input for "-"; otherwise the reason, for people. No more than the limit
// `file-size` is read, whatever the file.
struct Unreadable {
  std::string reason;
  std::string help = "";
  ExitCode code = kIo;
};
std::variant<std::string, Unreadable> read_text(const std::string& path, const compiler::Limits& limits,
                                                const Streams& streams);
ExitCode fail(const Streams& streams, const std::string& path, const Unreadable& unreadable);

// The file's name for messages: in a sentence, and before the number of a line.
std::string quoted(const std::string& path);
std::string source_name(const std::string& path);

// `code`, after a message in the form that --error-format says.
ExitCode fail_about(const SceneArguments& arguments, ExitCode code, const std::string& message, const Help& help,
                    const Streams& streams);

// `code`, after the error E0701 that is about a compiled scene or a listing as a whole. `error_format` is a
// compiler::ErrorFormat.
ExitCode fail_whole(const std::string& path, const std::string& reason, const std::string& remedy, int error_format,
                    const Streams& streams, ExitCode code = kBadScene);

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

// A Setter for the name of a pass, or "graph" for "before the first pass".
Setter pass_name(std::optional<std::string>& target);

}  // namespace fathom::cli
