// fathom import: writes models of other formats as ordinary scene files.
// Tested by: tests/runtime/cli/input/cli_import_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "compiler/frontend/formats/write_json.h"
#include "compiler/frontend/stage.h"
#include "runtime/cli/input/import_files.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kImportExamples =
    "fathom import prospero.vm -o prospero.json\n"
    "fathom import --bare molecule.json | fathom check -\n"
    "fathom import scene.fbc -o scene.json         # the text in a compiled scene\n"
    "\n"
    "Every verb reads these formats itself. `fathom import` is for changing the model.";

// Replaces control characters, so that the text fits into a one-line comment.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text;
}

}  // namespace

int run_import(std::span<const std::string> args, const Streams& streams) {
  SceneArguments scene_arguments;
  std::optional<std::string> output;
  bool bare = false;
  Arguments arguments("import", "Writes a model of another format as a scene file, on a ground and under a light.",
                      kImportExamples);
  add_scene_arguments(arguments, scene_arguments);
  arguments.option("-o,--output", "FILE", "Scene file to write (standard output)", any_text(output));
  arguments.flag("--bare", "Write the model alone, in front of a camera", bare);
  if (const auto code = arguments.parse(args, streams)) return *code;
  if (const auto code = check_text_output(output, streams)) return *code;
  auto read = read_scene_text(scene_arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  auto& [source, compiled_file] = std::get<SceneText>(read);
  if (compiled_file && !scene_arguments.definitions.empty()) {
    note(streams, "the text says nothing of the values that -D gave to parameters");
  }
  const auto compiled = compile_scene({source, std::nullopt}, scene_arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  compiler::Diagnostics ignored;  // compile_scene() has already printed the diagnostics
  std::optional<compiler::ReadScene> model =
      compiler::read_scene(source, ignored, scene_arguments.limits, {}, import_reader(scene_arguments, streams));
  const bool not_a_film =
      model && model->format != compiler::SceneFormat::Scene && model->format != compiler::SceneFormat::Text;
  if (!not_a_film && !compiled_file) {
    return fail(streams, kUsage, fmt::format("{} is a scene file already", cli::quoted(scene_arguments.path)));
  }
  std::string text = source.text();
  if (not_a_film) {
    if (!bare) compiler::set_stage(*model, std::get<compiler::CompiledScene>(compiled));
    text = fmt::format("// From {}.\n", printable(cli::quoted(scene_arguments.path))) +
           compiler::write_json(model->file);
  }
  return write_text_output(text, output, streams);
}

}  // namespace fathom::cli
