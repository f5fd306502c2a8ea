// fathom compile: writes a scene as a file of compiled programs. fathom asm: assembles such a file from its listing.
// Tested by: tests/runtime/cli/cli_compile_test.cpp
#include <fmt/format.h>

#include <ostream>
#include <string_view>
#include <utility>

#include "compiler/artefact/listing.h"
#include "compiler/artefact/programs.h"
#include "compiler/frontend/text/read_text.h"
#include "runtime/base/atomic_file.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/verbs.h"
#include "runtime/image/image_io.h"

namespace fathom::cli {
namespace {

constexpr const char* kCompileExamples =
    "fathom compile scene.fathom -o scene.fbc      # for every verb\n"
    "fathom compile scene.fathom -o scene.fbc --strip --no-text\n"
    "fathom compile old.fbc -o new.fbc             # compiled again from its text\n"
    "fathom render scene.fbc -o out.png -D r=0.3   # with a parameter";
constexpr const char* kAsmExamples =
    "fathom dump scene.fbc --stage file > scene.txt\n"
    "fathom asm scene.txt -o same.fbc              # the same bytes\n"
    "echo 'sphere 1' | fathom asm - -o ball.fbc";

// Writes the compiled scene to a file, or to standard output if `path` is "-".
ExitCode write_compiled(const compiler::CompiledScene& scene, const compiler::FileContents& contents,
                        const std::string& path, const Streams& streams) {
  const std::vector<std::uint8_t> bytes = compiler::write_file(scene, contents);
  if (path == "-") {
    streams.out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return kDone;
  }
  if (const auto problem = runtime::write_file(bytes, path)) return fail(streams, kIo, *problem);
  say(streams, fmt::format("wrote {} ({} bytes)", path, bytes.size()));
  return kDone;
}

// Returns the kind of file that the name's ending stands for if a compiled scene is not of that kind. Returns nullopt
// for .fbc, for no ending and for unknown endings.
std::optional<std::string_view> other_kind(const std::string& path) {
  constexpr std::pair<std::string_view, std::string_view> kKinds[] = {
      {".film", "a film"}, {".json", "a scene"}, {".vm", "a scene"}, {".stl", "a mesh"},
      {".obj", "a mesh"},  {".ply", "a mesh"},   {".glb", "a mesh"}, {".gltf", "a mesh"},
  };
  if (runtime::image_format_of(path)) return "a picture";
  for (const auto& [ending, kind] : kKinds) {
    if (path.ends_with(ending)) return kind;
  }
  return std::nullopt;
}

// True if the text begins like a scene, and like no listing.
bool is_scene(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != text.npos && (text[first] == '{' || text[first] == '/')) return true;
  return compiler::is_text_scene(text) && text.find("\nmachine ") == text.npos;
}

std::optional<ExitCode> check_output(const std::string& output, const Streams& streams) {
  if (output.empty()) return fail(streams, kUsage, "-o FILE is missing", {"- writes to standard output"});
  if (output == "-") return std::nullopt;
  if (const auto kind = other_kind(output)) {
    Help help = {"name it with .fbc at its end"};
    if (*kind == "a picture") help.push_back("`fathom render` draws pictures");
    return fail(streams, kUsage,
                fmt::format("`{}` is the name of {}, and this writes a compiled scene", output, *kind), help);
  }
  return check_output_files({output}, streams);
}

}  // namespace

int run_compile(std::span<const std::string> args, const Streams& streams) {
  SceneArguments scene_arguments;
  std::optional<std::string> output;
  bool strip = false, no_text = false;
  Arguments arguments("compile", "Compiles a scene to a file; see docs/reference/bytecode.md.", kCompileExamples);
  add_scene_arguments(arguments, scene_arguments);
  arguments.option("-o,--output", "FILE", "File to write, usually .fbc; - is standard output", any_text(output));
  arguments.flag("--strip", "Leave out the names of instructions and their places in the scene", strip);
  arguments.flag("--no-text", "Leave out the scene's text; then -D is refused, and `check` has nothing to prove",
                 no_text);
  if (const auto code = arguments.parse(args, streams)) return *code;
  if (const auto code = check_output(output.value_or(""), streams)) return *code;
  auto input = read_scene_text(scene_arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&input)) return *code;
  const auto compiled =
      compile_scene({std::get<SceneText>(std::move(input)).source, std::nullopt}, scene_arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  return write_compiled(std::get<compiler::CompiledScene>(compiled), {!strip, !no_text, scene_arguments.definitions},
                        *output, streams);
}

int run_asm(std::span<const std::string> args, const Streams& streams) {
  std::string path;
  std::optional<std::string> output;
  int error_format = 0;
  compiler::Limits limits;
  Arguments arguments("asm", "Assembles a listing to a compiled scene.", kAsmExamples);
  arguments.positional(
      "listing", "Output of `fathom dump --stage file`, or the listing of one program; - is standard input", path);
  arguments.option("-o,--output", "FILE", "File to write, usually .fbc; - is standard output", any_text(output));
  add_limit_option(arguments, limits);
  arguments.option("--error-format", "FORMAT", "Format of errors: text (default), short or json",
                   one_of({"text", "short", "json"}, error_format));
  if (const auto code = arguments.parse(args, streams)) return *code;
  if (const auto code = check_output(output.value_or(""), streams)) return *code;
  auto text = read_text(path, limits, streams);
  if (const auto* read_error = std::get_if<ReadError>(&text)) return fail(streams, path, *read_error);
  const compiler::Source listing(source_name(path), std::get<std::string>(std::move(text)));
  if (compiler::is_compiled_file(listing.text())) {
    return fail_whole(path, "it is a compiled scene, not a listing",
                      fmt::format("`fathom dump --stage file {}` prints its listing", path), error_format, streams);
  }
  if (is_scene(listing.text())) {
    return fail_whole(path, "it is a scene, not a listing",
                      fmt::format("`fathom compile {} -o scene.fbc` compiles it", path), error_format, streams);
  }
  compiler::Diagnostics diagnostics;
  compiler::FileContents contents;
  const auto scene = compiler::read_listing(listing, diagnostics, contents, limits);
  streams.err << diagnostics.print(listing, static_cast<compiler::ErrorFormat>(error_format), streams.color);
  if (!scene) return kBadScene;
  if (const auto excess = compiler::excess_of(*scene, limits)) {
    return fail_whole(path, excess->what, excess->remedy, error_format, streams);
  }
  return write_compiled(*scene, contents, *output, streams);
}

}  // namespace fathom::cli
