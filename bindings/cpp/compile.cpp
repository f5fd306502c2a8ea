#include "compiler/compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <fathom/fathom.hpp>
#include <filesystem>

#include "bindings/cpp/guard.h"
#include "bindings/cpp/scene_data.h"
#include "compiler/artefact/compiled_file.h"
#include "compiler/artefact/programs.h"
#include "runtime/load/files.h"

namespace fathom {
namespace {

compiler::Limits limits_of(const CompileOptions& options) {
  compiler::Limits limits;
  limits.memory = options.memory;
  limits.memory = runtime::allowed_memory(limits);
  return limits;
}

Diagnostic to_public(const compiler::Diagnostic& each, const compiler::Source& source) {
  Diagnostic out;
  out.error = each.severity == compiler::Severity::Error;
  out.code = each.code;
  out.message = each.message;
  out.label = each.label;
  out.help = each.help;
  const compiler::Source& file = source.file(each.span.begin);
  out.file = file.name();
  if (each.span.begin == 0 && each.span.end == 0) return out;
  const compiler::Position place = source.locate(each.span.begin);
  out.line = place.line;
  out.column = place.column;
  out.begin = each.span.begin - file.base();
  out.end = each.span.end - file.base();
  return out;
}

// Error of a scene whose diagnostics have errors: the first one, and the number of the others.
Error scene_error(const std::vector<Diagnostic>& all) {
  const auto first = std::ranges::find_if(all, &Diagnostic::error);
  const auto others = std::ranges::count_if(all, &Diagnostic::error) - 1;
  std::string message = first == all.end() ? "the scene has errors" : to_string({&*first, 1});
  while (message.ends_with('\n')) message.pop_back();
  if (others > 0) message += fmt::format(" (and {} more)", others);
  return {Error::Kind::BadScene, std::move(message)};
}

bool is_foreign(compiler::SceneFormat format) {
  return format != compiler::SceneFormat::Scene && format != compiler::SceneFormat::Text;
}

Error compile_text(const compiler::Source& source, const CompileOptions& options, compiler::Definitions definitions,
                   const compiler::ImportReader& imports, Compiled& out) {
  compiler::Source whole = source;
  bool foreign = false;
  compiler::CompileOptions how;
  how.limits = limits_of(options);
  how.definitions = std::move(definitions);
  how.imports = imports;
  how.pieces = true;
  how.on_source = [&](const compiler::Source& read) { whole = read; };
  how.on_syntax = [&](const compiler::ReadScene& read) { foreign = is_foreign(read.format); };
  compiler::Diagnostics diagnostics;
  auto scene = compiler::compile(source, diagnostics, how);
  for (const compiler::Diagnostic& each : diagnostics.all()) out.diagnostics.push_back(to_public(each, whole));
  if (!scene) return scene_error(out.diagnostics);
  auto data = std::make_shared<Scene::Data>(std::move(*scene));
  data->limits = how.limits;
  data->definitions = std::move(how.definitions);
  data->foreign = foreign;
  out.scene = Scene(std::move(data));
  return {};
}

// Reads a compiled file. Parameters replace numbers in the programs, so a file with parameters is compiled from its
// text. `foreign`: see Scene::Data.
Error read_compiled(const std::string& bytes, const std::string& path, const CompileOptions& options, bool foreign,
                    Compiled& out) {
  const compiler::Limits limits = limits_of(options);
  auto read =
      compiler::read_stored({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, path, limits);
  if (const auto* fault = std::get_if<compiler::FileError>(&read)) {
    return {Error::Kind::BadScene, fmt::format("{}: {}", path, fault->reason)};
  }
  auto& stored = std::get<compiler::StoredScene>(read);
  if (!options.parameters.empty()) {
    if (!stored.contents.text) {
      return {Error::Kind::BadArgument,
              fmt::format("{} holds programs without the scene they were compiled from, so that its parameters are "
                          "numbers in the programs",
                          path)};
    }
    compiler::Definitions definitions = stored.contents.definitions;
    definitions.insert(definitions.end(), options.parameters.begin(), options.parameters.end());
    return compile_text(stored.scene.source, options, std::move(definitions), {}, out);
  }
  if (const auto excess = compiler::excess_of(stored.scene, limits)) {
    return {Error::Kind::BadScene, fmt::format("{}: {}", path, excess->what)};
  }
  if (stored.contents.text) compiler::restore_pieces(stored.scene, stored.contents.definitions, limits);
  auto data = std::make_shared<Scene::Data>(std::move(stored.scene));
  data->limits = limits;
  data->definitions = stored.contents.definitions;
  data->has_text = stored.contents.text;
  data->foreign = foreign;
  out.scene = Scene(std::move(data));
  return {};
}

compiler::ImportReader reader_of(const CompileOptions& options, const std::string& folder) {
  return runtime::import_reader({
      .folder = folder.empty() ? std::filesystem::path(".") : std::filesystem::path(folder),
      .root = options.import_root,
      .limits = limits_of(options),
      .option = "import_root",
      .remedy = "import_root names the folder that imports may be read from",
      .on_import = {},
  });
}

compiler::ImportReader no_imports() {
  return [](const std::string&) -> std::variant<std::string, compiler::ImportFault> {
    return compiler::ImportFault{"the text has no folder", "the option `folder` names it"};
  };
}

// Refuses what no text or file can be called.
Error check(const CompileOptions& options) {
  if (Error error = library::check_path("name", options.name)) return error;
  if (Error error = library::check_path("folder", options.folder)) return error;
  return library::check_path("import_root", options.import_root.value_or(""));
}

}  // namespace

Compiled compile(std::string_view text, const CompileOptions& options) noexcept {
  Compiled out;
  out.error = library::guard([&]() -> Error {
    if (Error error = library::announced("text", text)) return error;
    if (Error error = check(options)) return error;
    const std::filesystem::path folder(options.folder);
    const std::string name = (folder / options.name).string();
    const auto imports = options.folder.empty() ? no_imports() : reader_of(options, options.folder);
    return compile_text(compiler::Source(name, std::string(text)), options, options.parameters, imports, out);
  });
  return out;
}

Compiled load(const std::string& path, const CompileOptions& options) noexcept {
  Compiled out;
  out.error = library::guard([&]() -> Error {
    if (Error error = library::check_path("path", path)) return error;
    if (Error error = check(options)) return error;
    auto read = runtime::read_file(path, limits_of(options));
    if (const auto* fault = std::get_if<runtime::FileFault>(&read)) {
      return {fault->too_large ? Error::Kind::BadScene : Error::Kind::File,
              fmt::format("cannot read `{}`: {}", path, fault->reason)};
    }
    auto& text = std::get<std::string>(read);
    if (compiler::is_compiled_file(text)) return read_compiled(text, path, options, false, out);
    const auto imports = reader_of(options, std::filesystem::path(path).parent_path().string());
    return compile_text(compiler::Source(path, std::move(text)), options, options.parameters, imports, out);
  });
  return out;
}

Compiled unpack(std::string_view bytes) noexcept {
  Compiled out;
  out.error = library::guard([&]() -> Error {
    if (Error error = library::announced("bytes", bytes)) return error;
    const char kind = bytes.empty() ? '\0' : bytes.front();
    if (kind != library::kScene && kind != library::kForeign)
      return library::bad_argument("bytes is no packed scene");
    return read_compiled(std::string(bytes.substr(1)), "packed scene", {}, kind == library::kForeign, out);
  });
  return out;
}

std::string to_string(std::span<const Diagnostic> diagnostics) {
  std::string text;
  for (const Diagnostic& each : diagnostics) {
    text += each.file;
    if (each.line > 0) text += fmt::format(":{}:{}", each.line, each.column);
    text += fmt::format(": {}[{}]: {}\n", each.error ? "error" : "warning", each.code, each.message);
    for (const std::string& help : each.help) text += fmt::format("  = help: {}\n", help);
  }
  return text;
}

std::optional<compiler::CompiledScene> library::compile_picture(const Scene::Data& data,
                                                                const compiler::Definitions& more,
                                                                std::optional<glm::dvec3> origin,
                                                                std::string& message) {
  compiler::CompileOptions how;
  how.limits = data.limits;
  how.definitions = data.definitions;
  how.definitions.insert(how.definitions.end(), more.begin(), more.end());
  how.stage = data.foreign;
  how.origin = origin;
  how.pieces = true;
  how.file_at_hand = data.scene.background.image.file;
  compiler::Diagnostics diagnostics;
  auto scene = compiler::compile(data.scene.source, diagnostics, how);
  if (!scene) message = diagnostics.print(data.scene.source, compiler::ErrorFormat::Short);
  return scene;
}

}  // namespace fathom
