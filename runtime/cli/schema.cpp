// fathom schema: prints the files that editors need for scenes: the JSON Schema, and the vocabulary of the notation.
// Tested by: tests/runtime/cli/cli_dump_test.cpp, tests/runtime/cli/cli_editor_test.cpp
#include "compiler/frontend/records/schema.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <ostream>

#include "runtime/cli/editor_files.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kSchemaExamples =
    "fathom schema > scene.schema.json\n"
    "fathom schema --editor vim > ~/.vim/syntax/fathom.vim\n"
    "fathom schema --editor vscode -o ~/.vscode/extensions/fathom\n"
    "\n"
    "A JSON scene names its schema in its first property: \"$schema\": \"./scene.schema.json\"";

ExitCode write_extension(const std::string& folder, const Streams& streams) {
  for (const EditorFile& file : vscode_extension()) {
    const std::filesystem::path path = std::filesystem::path(folder) / file.path;
    if (const auto problem = write_text(file.text, path.string())) return fail(streams, kIo, *problem);
  }
  say(streams, fmt::format("wrote {}", folder));
  return kDone;
}

}  // namespace

int run_schema(std::span<const std::string> args, const Streams& streams) {
  int editor = 0;
  std::optional<std::string> output;
  Arguments arguments("schema", "Prints the JSON Schema (draft 2020-12) of scene files, or what an editor reads.",
                      kSchemaExamples);
  arguments.option("--editor", "NAME",
                   "Print in its place how texts are coloured: vim, or vscode, an extension with a problem matcher",
                   one_of({"none", "vim", "vscode"}, editor));
  arguments.option("-o,--output", "PATH", "File to write (standard output); with --editor vscode a folder",
                   any_text(output));
  if (const auto code = arguments.parse(args, streams)) return *code;
  if (editor == 2) {
    if (!output || output == "-") return fail(streams, kUsage, "--editor vscode writes a folder: -o names it");
    return write_extension(*output, streams);
  }
  if (const auto code = check_text_output(output, streams)) return *code;
  const std::string text = editor == 1 ? vim_syntax() : compiler::scene_schema();
  return write_text_output(text, output, streams);
}

}  // namespace fathom::cli
