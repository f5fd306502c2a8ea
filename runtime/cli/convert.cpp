// fathom convert: converts scenes from JSON to text and back.
// Tested by: tests/runtime/cli/cli_convert_test.cpp
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ostream>

#include "compiler/frontend/formats/write_json.h"
#include "compiler/frontend/read_scene.h"
#include "compiler/frontend/text/print.h"
#include "runtime/cli/input/import_files.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kConvertExamples =
    "fathom convert scene.json -o scene.fathom\n"
    "fathom convert scene.fathom -o scene.json\n"
    "\n"
    "A JSON scene comes back from text as it was. Of a text's functions, loops and names JSON keeps what they came "
    "to, "
    "and its parameters where they decide no loop or condition.";

// Notes the places where the conversion replaced parameters by their values, because it needed numbers.
void note_frozen(const std::vector<compiler::Span>& frozen, const compiler::Source& source, const Streams& streams) {
  std::vector<std::string> places;
  for (const compiler::Span span : frozen) {
    const std::string place = source.place(span.begin);
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  }
  if (places.empty()) return;
  const std::size_t shown = std::min<std::size_t>(places.size(), 5);
  note(streams, fmt::format("parameters have their default at {}{}: -D does not change it in the JSON scene",
                            fmt::join(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                            shown < places.size() ? ", ..." : ""));
}

}  // namespace

int run_convert(std::span<const std::string> args, const Streams& streams) {
  SceneArguments scene_arguments;
  std::optional<std::string> output;
  Arguments arguments("convert", "Writes a JSON scene as text, or a text as JSON.", kConvertExamples);
  add_scene_arguments(arguments, scene_arguments);
  arguments.option("-o,--output", "FILE", "Scene file to write (standard output)", any_text(output));
  if (const auto code = arguments.parse(args, streams)) return *code;
  if (!scene_arguments.definitions.empty()) {
    return fail(streams, kUsage, "`convert` keeps the parameters: -D is for what reads the scene it writes");
  }
  if (const auto code = check_text_output(output, streams)) return *code;
  auto read = read_scene_text(scene_arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  compiler::Source& source = std::get<SceneText>(read).source;
  const auto compiled = compile_scene({source, std::nullopt}, scene_arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  compiler::Diagnostics ignored;  // compile_scene() has already printed the diagnostics
  std::string text;
  if (compiler::is_text_scene(source.text())) {
    const auto kept =
        compiler::read_with_formulas(source, ignored, scene_arguments.limits, import_reader(scene_arguments, streams));
    note_frozen(kept->frozen, source, streams);
    text = compiler::write_json(kept->file, compiler::comments_of_text(source, kept->file));
  } else {
    const auto scene = compiler::read_scene(source, ignored, scene_arguments.limits);
    text = compiler::text::print_text(scene->file, source);
  }
  return write_text_output(text, output, streams);
}

}  // namespace fathom::cli
