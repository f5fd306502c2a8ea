#include "runtime/cli/input/scene_arguments.h"

#include <fmt/format.h>

#include <cmath>
#include <ostream>

#include "compiler/compile.h"
#include "compiler/frontend/formula/read_formula.h"
#include "runtime/cli/input/text_file.h"

namespace fathom::cli {
namespace {

// Reads a definition: "r=0.5" or "angle=pi/4".
OptionResult read_definition(std::string_view text, std::pair<std::string, double>& definition) {
  const std::size_t middle = text.find('=');
  if (middle == std::string_view::npos || middle == 0) {
    return OptionError{fmt::format("`{}` is not a name and a value", text), "write it as r=0.5"};
  }
  const std::string_view formula = text.substr(middle + 1);
  compiler::Diagnostics diagnostics;
  const auto value = compiler::read_number({{}, std::string(formula)}, compiler::Scope(), diagnostics);
  if (!value) {
    const compiler::Diagnostic& first = diagnostics.all().front();
    return OptionError{fmt::format("`{}`: {}", formula, first.message), first.help.empty() ? "" : first.help.front()};
  }
  definition = {std::string(text.substr(0, middle)), *value};
  return std::nullopt;
}

// Reads a limit, "nodes=2000000". The value may be a formula.
OptionResult read_limit(std::string_view text, compiler::Limits& limits) {
  std::pair<std::string, double> given;
  if (OptionResult error = read_definition(text, given)) {
    if (text.find('=') == std::string_view::npos || text.starts_with('=')) error->help = "write it as nodes=2000000";
    return error;
  }
  const auto& [name, value] = given;
  const compiler::LimitRow* row = compiler::find_limit(name);
  if (row == nullptr) {
    std::vector<std::string_view> names;
    for (const compiler::LimitRow& known : compiler::kLimits) names.push_back(known.name);
    const std::string_view near = compiler::nearest(name, names);
    return OptionError{fmt::format("there is no limit `{}`", name),
                       near.empty() ? "`fathom help limits` lists them" : fmt::format("did you mean `{}`?", near)};
  }
  const bool whole = value == std::floor(value) || row->value == &compiler::Limits::coordinate;
  if (!(value >= 1 && value <= row->largest && whole)) {
    return OptionError{
        fmt::format("`{}` can be from 1 to {:.15g} {}{}", name, row->largest, row->unit, whole ? "" : ", whole ones"),
        value > row->largest ? fmt::format("it goes no higher for {}", row->why) : ""};
  }
  limits.*row->value = value;
  return std::nullopt;
}

constexpr const char* kAboutScene =
    "Scene file: text or JSON, a file of `fathom compile`, or another format that Fathom reads; - is standard input";

void add_scene_options(Arguments& arguments, SceneArguments& scene) {
  add_define_option(arguments, scene);
  arguments.option("--root", "DIR", "Folder that the scene may import files from (the scene's own)",
                   any_text(scene.root));
  add_limit_option(arguments, scene.limits);
  add_error_format_option(arguments, scene);
}

}  // namespace

void add_scene_arguments(Arguments& arguments, SceneArguments& scene, bool required) {
  arguments.positional("scene", kAboutScene, scene.path, required);
  add_scene_options(arguments, scene);
}

void add_scene_arguments(Arguments& arguments, SceneArguments& scene, std::vector<std::string>& paths) {
  arguments.positionals("scene", kAboutScene, paths);
  add_scene_options(arguments, scene);
}

void add_define_option(Arguments& arguments, SceneArguments& scene) {
  arguments.option("-D,--define", "NAME=VALUE",
                   "Set a parameter of the scene to a number or a formula, as r=0.5 or angle=pi/4",
                   append_to(read_definition, scene.definitions));
}

void add_error_format_option(Arguments& arguments, SceneArguments& scene) {
  arguments.option("--error-format", "FORMAT", "Format of errors and warnings: text (default), short or json",
                   one_of({"text", "short", "json"}, scene.error_format));
}

void add_limit_option(Arguments& arguments, compiler::Limits& limits) {
  arguments.option("--limit", "NAME=VALUE",
                   "Change a limit on what files may ask for, as nodes=2000000; `fathom help limits` lists them",
                   [&limits](std::string_view text) { return read_limit(text, limits); });
}

ExitCode fail_about(const SceneArguments& arguments, ExitCode code, const std::string& message, const Help& help,
                    const Streams& streams) {
  const auto format = static_cast<compiler::ErrorFormat>(arguments.error_format);
  if (format == compiler::ErrorFormat::Text) return fail(streams, code, message, help);
  compiler::Diagnostics diagnostics;
  diagnostics.error("E0701", {}, message, "", help);
  streams.err << diagnostics.print(compiler::Source(source_name(arguments.path), ""), format);
  return code;
}

ExitCode fail_whole(const std::string& path, const std::string& reason, const std::string& remedy, int error_format,
                    const Streams& streams, ExitCode code) {
  Help help;
  if (!remedy.empty()) help.push_back(remedy);
  const bool text = static_cast<compiler::ErrorFormat>(error_format) == compiler::ErrorFormat::Text;
  return fail_about({path, error_format, {}, {}}, code,
                    text ? fmt::format("{}: {}", cli::quoted(path), reason) : reason, help, streams);
}

Setter pass_name(std::optional<std::string>& target) {
  std::vector<std::string_view> names = {"graph"};
  for (const std::string_view name : compiler::pass_names()) names.push_back(name);
  const auto set = [names, &target](std::string_view text) -> OptionResult {
    int index = 0;
    OptionResult error = one_of(names, index)(text);
    if (!error) target = text;
    return error;
  };
  return {set, {names.begin(), names.end()}};
}

}  // namespace fathom::cli
