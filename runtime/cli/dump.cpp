// fathom dump: what the compiler made of a scene, after its front end, after a pass, or as bytecode.
// Tested by: tests/runtime/cli_test.cpp
#include <fmt/format.h>

#include <ostream>

#include "runtime/cli/operation_table.h"
#include "runtime/cli/scene_file.h"
#include "runtime/cli/verbs.h"
#include "vm/disassemble.h"

namespace fathom::cli {
namespace {

constexpr const char* kExamples =
    "fathom dump scene.json                        # the distance program\n"
    "fathom dump scene.json --program surface      # the one that knows the objects\n"
    "fathom dump scene.json --stage graph          # after all passes\n"
    "fathom dump scene.json --after graph          # before the first\n"
    "fathom dump scene.json --stats                # which operations cost what";

enum Stage { kSyntax, kGraph, kBytecode };

struct DumpRequest {
  SceneArguments scene;
  int stage = -1;    // a Stage; -1: not given
  int program = -1;  // 0 distance, 1 surface; -1: not given
  std::optional<std::string> after;
  bool stats = false;
};

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, DumpRequest& request) {
  Arguments arguments("dump", "Prints what the compiler made of a scene.", kExamples);
  add_scene_arguments(arguments, request.scene);
  arguments.option("--stage", "STAGE", "syntax, graph or bytecode (default: bytecode, or graph with --after)",
                   one_of({"syntax", "graph", "bytecode"}, request.stage));
  arguments.option("--after", "PASS", "Stop after this pass of the compiler; graph stops before the first",
                   pass_name(request.after));
  arguments.option("--program", "PROGRAM", "distance (the default) or surface",
                   one_of({"distance", "surface"}, request.program));
  arguments.flag("--stats", "Print how often each operation occurs and its cost in multiply-adds", request.stats);
  if (const auto code = arguments.parse(args, streams)) return code;

  if (request.stage < 0) request.stage = request.after && !request.stats && request.program < 0 ? kGraph : kBytecode;
  if (request.stage != kBytecode && (request.stats || request.program >= 0)) {
    return fail(streams, kUsage, fmt::format("{} is about bytecode", request.stats ? "--stats" : "--program"),
                {"use it with --stage bytecode"});
  }
  if (request.stage == kSyntax && request.after) {
    return fail(streams, kUsage, "--after names a pass, and the syntax is what passes start from",
                {"use it with --stage graph or --stage bytecode"});
  }
  return std::nullopt;
}

}  // namespace

int run_dump(std::span<const std::string> args, const Streams& streams) {
  DumpRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  auto read = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  const compiler::Source& source = std::get<compiler::Source>(read);

  std::string syntax, graph;
  compiler::CompileOptions options;
  options.stop_after = request.after;
  if (request.stage == kSyntax) {
    options.on_syntax = [&](const compiler::syntax::File& file) { syntax = compiler::syntax::print_syntax(file); };
  }
  if (request.stage == kGraph) {
    options.on_pass = [&](std::string_view, const compiler::Scene& scene) { graph = print_graph(scene, source); };
  }
  const auto compiled = compile_scene(source, request.scene, streams, options);
  if (request.stage == kSyntax) streams.out << syntax;  // of a scene with errors in it, too
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  const auto& scene = std::get<compiler::CompiledScene>(compiled);
  if (request.stage == kGraph) streams.out << graph;
  if (request.stage == kBytecode) {
    const vm::VerifiedProgram& program = request.program == 1 ? scene.surface : scene.distance;
    if (!request.stats) {
      streams.out << fmt::format("; {}: {}\n", request.program == 1 ? "surface" : "distance", scene.summary);
    }
    streams.out << (request.stats ? operation_table(program) : vm::disassemble(program));
  }
  return kDone;
}

}  // namespace fathom::cli
