#include "runtime/cli/input/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ostream>
#include <span>

#include "compiler/artefact/programs.h"
#include "runtime/cli/input/import_files.h"
#include "runtime/cli/input/memory.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/input/verbosity.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/options/step_line.h"
#include "vm/encoding/printable.h"

namespace fathom::cli {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Reads a scene file of any kind. The Source carries the file's name for messages.
std::variant<compiler::Source, ExitCode> read_any(const SceneArguments& arguments, const Streams& streams) {
  const std::string& path = arguments.path;
  auto text = read_text(path, arguments.limits, streams);
  if (const auto* read_error = std::get_if<ReadError>(&text)) {
    const Help help = read_error->help.empty() ? Help{} : Help{read_error->help};
    return fail_about(arguments, read_error->code,
                      fmt::format("cannot read {}: {}", cli::quoted(path), read_error->reason), help, streams);
  }
  return compiler::Source(source_name(path), std::get<std::string>(std::move(text)));
}

// Returns a path whose folder locates the scene's other files. For standard input that is the current folder.
std::string folder_name(const std::string& path) { return path == "-" ? "" : path; }

// Concatenates definitions. A later definition of the same name overrides an earlier one.
compiler::Definitions both(compiler::Definitions first, const compiler::Definitions& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

// Adds the picture that the scene shows as background to the files that are read. Prints a message and returns an exit
// code if an output would overwrite one of them.
std::optional<ExitCode> check_inputs(const compiler::CompiledScene& scene, const Streams& streams) {
  if (scene.background.type == compiler::Background::Type::Image) {
    streams.files.add_input(scene.background.image.file);
  }
  return check_files(streams);
}

// True if the options ask for intermediate results of the compilation. on_pass does not count, because it only
// observes.
bool asks_for_graph(const compiler::CompileOptions& options) {
  return options.stop_after || options.on_syntax || options.lint;
}

ExitCode fail_without_text(const SceneArguments& arguments, const Streams& streams) {
  Help help = {"`fathom compile` without --no-text keeps the text"};
  if (!arguments.definitions.empty()) help.insert(help.begin(), "its parameters are numbers in the programs by now");
  return fail(streams, kUsage,
              fmt::format("{} holds programs without the scene they were compiled from", cli::quoted(arguments.path)),
              help);
}

// Returns the stored scene, if it is within the limits.
std::variant<compiler::CompiledScene, ExitCode> take_stored(compiler::StoredScene stored,
                                                            const SceneArguments& arguments, const Streams& streams) {
  if (const auto excess = compiler::excess_of(stored.scene, arguments.limits)) {
    return fail_whole(arguments.path, excess->what, excess->remedy, arguments.error_format, streams);
  }
  if (!stored.contents.text) stored.scene.camera.shutter = 0;  // other moments are compiled from the text
  return as_claimed(std::move(stored.scene));
}

// Renames the source for messages: text from a compiled file gets the names of both files.
compiler::Source named(const compiler::Source& source, const std::string& path) {
  const std::string name = source_name(path);
  if (path.empty() || source.name() == name) return source;
  return source.renamed(fmt::format("{} ({})", name, source.name()));
}

void print(const compiler::Diagnostics& diagnostics, const compiler::Source& source, const SceneArguments& arguments,
           const Streams& streams) {
  const auto format = static_cast<compiler::ErrorFormat>(arguments.error_format);
  streams.err << diagnostics.print(source, format, streams.color);
  const std::size_t errors = diagnostics.errors(), warnings = diagnostics.warnings();
  if (format != compiler::ErrorFormat::Text || (errors == 0 && !arguments.count_warnings)) return;
  std::vector<std::string> counts;
  if (errors > 0) counts.push_back(count_of(errors, "error"));
  if (warnings > 0) counts.push_back(count_of(warnings, "warning"));
  streams.err << vm::printable(source.name()) << ": " << fmt::format("{}", fmt::join(counts, ", ")) << '\n';
}

// True if one of the errors concerns the command line's values for parameters (E05xx).
bool about_definitions(const compiler::Diagnostics& diagnostics) {
  const auto& all = diagnostics.all();
  return std::any_of(all.begin(), all.end(), [](const auto& d) { return d.code.starts_with("E05"); });
}

}  // namespace

std::variant<SceneInput, ExitCode> read_scene(const SceneArguments& arguments, const Streams& streams) {
  auto read = read_any(arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  auto& source = std::get<compiler::Source>(read);
  if (!compiler::is_compiled_file(source.text())) return SceneInput{std::move(source), std::nullopt};
  auto stored = compiler::read_stored(bytes_of(source.text()), folder_name(arguments.path), arguments.limits);
  if (const auto* error = std::get_if<compiler::FileError>(&stored)) {
    return fail_whole(arguments.path, error->reason, error->remedy, arguments.error_format, streams);
  }
  auto& scene = std::get<compiler::StoredScene>(stored);
  return SceneInput{scene.scene.source, std::move(scene)};
}

std::variant<SceneText, ExitCode> read_scene_text(SceneArguments& arguments, const Streams& streams) {
  auto read = read_any(arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  auto& source = std::get<compiler::Source>(read);
  if (!compiler::is_compiled_file(source.text())) return SceneText{std::move(source)};
  auto text = compiler::read_stored_text(bytes_of(source.text()), folder_name(arguments.path));
  if (const auto* error = std::get_if<compiler::FileError>(&text)) {
    const ExitCode code = error->textless ? kUsage : kBadScene;
    return fail_whole(arguments.path, error->reason, error->remedy, arguments.error_format, streams, code);
  }
  auto& stored = std::get<compiler::StoredText>(text);
  arguments.definitions = both(stored.definitions, arguments.definitions);
  return SceneText{std::move(stored.source), true};
}

std::variant<compiler::CompiledScene, ExitCode> compile_scene(SceneInput input, const SceneArguments& arguments,
                                                              const Streams& streams,
                                                              compiler::CompileOptions options) {
  Verbosity verbosity(streams.verbosity, streams);
  if (input.stored) {
    const bool needs_text = !arguments.definitions.empty() || asks_for_graph(options);
    if (!needs_text) {
      const bool has_text = input.stored->contents.text;
      const compiler::Definitions definitions = input.stored->contents.definitions;
      auto scene = take_stored(*std::move(input.stored), arguments, streams);
      if (const auto* read = std::get_if<compiler::CompiledScene>(&scene)) {
        if (const auto code = check_inputs(*read, streams)) return *code;
        verbosity.describe(*read);
      }
      if (auto* read = std::get_if<compiler::CompiledScene>(&scene); read && options.pieces && has_text)
        compiler::restore_pieces(*read, definitions, arguments.limits);
      return scene;
    }
    if (!input.stored->contents.text) return fail_without_text(arguments, streams);
  }
  compiler::Diagnostics diagnostics;
  options.definitions =
      input.stored ? both(input.stored->contents.definitions, arguments.definitions) : arguments.definitions;
  options.limits = arguments.limits;
  options.limits.memory = allowed_memory(arguments.limits);
  // A compiled file is rendered as is: its model is not put on a stage with ground and lamp.
  if (input.stored) options.stage = false;
  StepLine line(streams, "compiling " + source_name(arguments.path));
  options.on_pass = [&line, watch = verbosity.watch_compiler().on_pass, own = options.on_pass](
                        std::string_view pass, const compiler::Scene& graph) {
    line.begin(pass);
    if (own) own(pass, graph);
    if (watch) watch(pass, graph);
  };
  if (!input.stored) options.imports = import_reader(arguments, streams);
  options.on_source = [&](const compiler::Source& whole) {
    if (!whole.imports().empty()) input.source = whole;
  };
  auto scene = compiler::compile(input.source, diagnostics, options);
  line.end();
  if (scene && arguments.inspect) arguments.inspect(*scene, diagnostics);
  if (!diagnostics.all().empty()) print(diagnostics, named(input.source, arguments.path), arguments, streams);
  if (!scene) return about_definitions(diagnostics) ? kUsage : kBadScene;
  if (const auto code = check_inputs(*scene, streams)) return *code;
  verbosity.describe(*scene);
  if (input.stored && options.lint && arguments.definitions.empty() &&
      compiler::scene_digest(*scene) != compiler::scene_digest(input.stored->scene)) {
    return fail_whole(arguments.path, "its programs are not those of the scene in it, so nothing is proved of them",
                      "`fathom compile` makes it anew", arguments.error_format, streams);
  }
  return std::move(*scene);
}

std::variant<compiler::CompiledScene, ExitCode> compile_checked(const SceneInput& input,
                                                                const SceneArguments& arguments,
                                                                compiler::Scene& graph, const Streams& streams,
                                                                compiler::CompileOptions options) {
  options.lint = true;
  options.on_pass = [&](std::string_view pass, const compiler::Scene& stage) {
    if (pass == "graph") graph = stage;
  };
  return compile_scene(input, arguments, streams, std::move(options));
}

std::variant<compiler::Animation, ExitCode> read_animation(SceneInput& input, const SceneArguments& arguments,
                                                           const Streams& streams) {
  if (input.stored && !input.stored->contents.text) return fail_without_text(arguments, streams);
  compiler::Diagnostics diagnostics;
  const compiler::Definitions definitions =
      input.stored ? both(input.stored->contents.definitions, arguments.definitions) : arguments.definitions;
  const auto animation = compiler::read_animation(input.source, diagnostics, arguments.limits, definitions,
                                                  import_reader(arguments, streams));
  if (animation) return *animation;  // compile_scene() reports the warnings later
  print(diagnostics, named(input.source, arguments.path), arguments, streams);
  return about_definitions(diagnostics) ? kUsage : kBadScene;
}

compiler::CompiledScene as_claimed(compiler::CompiledScene stored) {
  constexpr std::string_view kProved = "(proved)";
  std::string& summary = stored.summary;
  for (std::size_t at; (at = summary.find(kProved)) != summary.npos;)
    summary.replace(at, kProved.size(), "(claimed)");
  return stored;
}

}  // namespace fathom::cli
