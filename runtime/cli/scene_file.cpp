#include "runtime/cli/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "compiler/frontend/formula.h"

namespace fathom::cli {
namespace {

constexpr std::size_t kMaxBytes = 256u << 20;  // of a text file; keeps /dev/zero from filling the memory

std::variant<std::string, Unreadable> read_all(std::istream& in) {
  std::string text;
  char block[1 << 16];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(in.gcount()));
    if (text.size() > kMaxBytes) return Unreadable{"larger than 256 MiB"};
  }
  if (in.bad()) return Unreadable{std::strerror(errno)};
  return text;
}

// "r=0.5" or "angle=pi/4".
Verdict read_definition(std::string_view text, std::pair<std::string, double>& definition) {
  const std::size_t middle = text.find('=');
  if (middle == std::string_view::npos || middle == 0) {
    return Complaint{fmt::format("`{}` is not a name and a value", text), "write it as r=0.5"};
  }
  const std::string_view formula = text.substr(middle + 1);
  compiler::Diagnostics diagnostics;
  const auto value = compiler::read_number({{}, std::string(formula)}, compiler::Scope(), diagnostics);
  if (!value) {
    const compiler::Diagnostic& first = diagnostics.all().front();
    return Complaint{fmt::format("`{}`: {}", formula, first.message), first.help.empty() ? "" : first.help.front()};
  }
  definition = {std::string(text.substr(0, middle)), *value};
  return std::nullopt;
}

// Whether anything is wrong with the command line's values for parameters (E05xx).
bool about_definitions(const compiler::Diagnostics& diagnostics) {
  const auto& all = diagnostics.all();
  return std::any_of(all.begin(), all.end(), [](const auto& d) { return d.code.starts_with("E05"); });
}

}  // namespace

void add_scene_arguments(Arguments& arguments, SceneArguments& scene, bool required) {
  arguments.positional("scene", "The scene, a JSON file or another format it knows; - reads standard input",
                       scene.path, required);
  arguments.option("-D,--define", "NAME=VALUE", "A parameter's value: a number, or a formula such as pi/4",
                   append_to(read_definition, scene.definitions));
  arguments.option("--error-format", "FORMAT", "How to print what is wrong with the scene: text, short or json",
                   one_of({"text", "short", "json"}, scene.error_format));
}

std::variant<std::string, Unreadable> read_text(const std::string& path, const Streams& streams) {
  if (path == "-") return read_all(streams.in);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return Unreadable{"it is a directory"};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return Unreadable{std::strerror(errno)};
  return read_all(file);
}

std::string quoted(const std::string& path) { return path == "-" ? "standard input" : "`" + path + "`"; }

std::variant<compiler::Source, ExitCode> read_scene(const SceneArguments& arguments, const Streams& streams) {
  auto text = read_text(arguments.path, streams);
  if (const auto* unreadable = std::get_if<Unreadable>(&text)) {
    return fail(streams, kIo, fmt::format("cannot read {}: {}", quoted(arguments.path), unreadable->reason));
  }
  return compiler::Source(arguments.path == "-" ? "<stdin>" : arguments.path, std::get<std::string>(std::move(text)));
}

std::variant<compiler::CompiledScene, ExitCode> compile_scene(compiler::Source source,
                                                              const SceneArguments& arguments, const Streams& streams,
                                                              compiler::CompileOptions options) {
  const auto format = static_cast<compiler::ErrorFormat>(arguments.error_format);
  const compiler::Source copy = source;
  compiler::Diagnostics diagnostics;
  options.definitions = arguments.definitions;
  auto scene = compiler::compile(std::move(source), diagnostics, options);
  const std::string printed = diagnostics.print(copy, format, streams.color);
  streams.err << printed;
  const std::size_t errors = diagnostics.errors(), warnings = diagnostics.all().size() - errors;
  if (errors > 0 && format == compiler::ErrorFormat::Text) {
    streams.err << copy.name() << ": " << count_of(errors, "error")
                << (warnings > 0 ? ", " + count_of(warnings, "warning") : "") << '\n';
  }
  if (scene) return std::move(*scene);
  return about_definitions(diagnostics) ? kUsage : kBadScene;
}

Setter pass_name(std::optional<std::string>& target) {
  std::vector<std::string_view> names = {"graph"};
  for (const std::string_view name : compiler::pass_names()) names.push_back(name);
  return [names, &target](std::string_view text) -> Verdict {
    int index = 0;
    Verdict verdict = one_of(names, index)(text);
    if (!verdict) target = text;
    return verdict;
  };
}

}  // namespace fathom::cli
