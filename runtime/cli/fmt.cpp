// fathom fmt: lays out scenes in Fathom's own notation.
// Tested by: tests/runtime/cli/cli_convert_test.cpp
#include <fmt/format.h>

#include <ostream>

#include "compiler/frontend/syntax/json_error.h"
#include "compiler/frontend/text/format.h"
#include "compiler/frontend/text/parse/parser.h"
#include "compiler/frontend/text/read_text.h"
#include "runtime/cli/input/memory.h"
#include "runtime/cli/input/scene_arguments.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kFmtExamples =
    "fathom fmt scene.fathom              # prints it\n"
    "fathom fmt -w scenes/*.fathom        # writes what changes\n"
    "fathom fmt --check scenes/*.fathom   # status 1 when anything would change\n"
    "\n"
    "Line breaks are the author's; blanks and indentation are not.";

enum class FmtMode { Print, Write, Check };

// Prints, rewrites or checks one file, depending on `mode`.
ExitCode format_file(const std::string& path, FmtMode mode, const compiler::Limits& limits, const Streams& streams) {
  auto read = read_text(path, limits, streams);
  if (const auto* read_error = std::get_if<ReadError>(&read)) return fail(streams, path, *read_error);
  const compiler::Source source(source_name(path), std::get<std::string>(std::move(read)));
  if (!compiler::is_text_scene(source.text())) {
    return fail(streams, kBadScene, fmt::format("{} does not begin with `fathom 1`", cli::quoted(path)),
                {"`fathom convert` writes a JSON scene as text"});
  }
  compiler::Diagnostics diagnostics;
  if (compiler::check_text(source, diagnostics)) compiler::text::parse(source, diagnostics, limits);
  if (diagnostics.has_errors()) {
    streams.err << diagnostics.print(source, compiler::ErrorFormat::Text, streams.color);
    return kBadScene;
  }
  const std::string text = compiler::text::format_text(source);
  if (mode == FmtMode::Print) {
    streams.out << text;
    return kDone;
  }
  if (text == source.text()) return kDone;
  if (mode == FmtMode::Check) {
    say(streams, fmt::format("{} would change", path));
    return kFoundProblems;
  }
  if (const auto problem = write_text(text, path)) return fail(streams, kIo, *problem);
  say(streams, fmt::format("wrote {}", path));
  return kDone;
}

}  // namespace

int run_fmt(std::span<const std::string> args, const Streams& streams) {
  std::vector<std::string> paths;
  compiler::Limits limits;
  bool write = false, check = false;
  Arguments arguments("fmt", "Lays out scenes in Fathom's own notation.", kFmtExamples);
  arguments.positionals("file", "Scene that begins with `fathom 1`; - is standard input", paths);
  arguments.flag("-w,--write", "Write the files that change", write);
  arguments.flag("--check", "Write nothing, and end with 1 when a file would change", check);
  add_limit_option(arguments, limits);
  if (const auto code = arguments.parse(args, streams)) return *code;
  if (write && check) return fail(streams, kUsage, "-w and --check exclude each other");
  const FmtMode mode = write ? FmtMode::Write : check ? FmtMode::Check : FmtMode::Print;
  if (write && std::ranges::find(paths, "-") != paths.end()) {
    return fail(streams, kUsage, "standard input cannot be written to: leave out -w");
  }
  int worst = kDone;
  for (const std::string& path : paths) worst = std::max<int>(worst, format_file(path, mode, limits, streams));
  return worst;
}

}  // namespace fathom::cli
