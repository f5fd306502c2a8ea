// fathom dump: prints the compiler's stages of a scene: after the front end, after a pass, or as bytecode.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <ostream>

#include "compiler/artefact/listing.h"
#include "compiler/frontend/formats/print_syntax.h"
#include "compiler/graph_export.h"
#include "compiler/pass_diff.h"
#include "compiler/shapes/print_graph.h"
#include "runtime/cli/dump/operation_table.h"
#include "runtime/cli/dump/program_diff.h"
#include "runtime/cli/dump/program_json.h"
#include "runtime/cli/dump/region_listing.h"
#include "runtime/cli/dump/trace_listing.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/verbs.h"
#include "vm/encoding/disassemble.h"

namespace fathom::cli {
namespace {

constexpr const char* kDumpExamples =
    "fathom dump scene.fathom                      # the distance program\n"
    "fathom dump scene.fathom --program surface    # with the objects\n"
    "fathom dump scene.fathom --stage graph        # after all passes\n"
    "fathom dump scene.fathom --after graph        # before the first pass\n"
    "fathom dump scene.fathom --diff               # the changes of each pass\n"
    "fathom dump --diff a.fbc b.fbc                # two programs compared\n"
    "fathom dump scene.fathom --run --at 0,1,0     # the stacks at a point\n"
    "fathom dump scene.fathom --stats              # the cost of each part\n"
    "fathom dump scene.fbc --stage file            # all, for `fathom asm`\n"
    "fathom dump scene.fathom --region 0,1,0       # the part for a point\n"
    "fathom dump scene.fathom --stage graph --format dot | dot -Tsvg > graph.svg";

enum Stage { kSyntax, kGraph, kBytecode, kFile };
enum Format { kText, kJson, kDot, kMermaid };

struct DumpRequest {
  SceneArguments scene;
  int stage = -1;    // a Stage; -1: not given
  int format = -1;   // a Format; -1: not given
  int program = -1;  // 0 distance, 1 surface; -1: not given
  std::optional<std::string> after;
  std::optional<glm::dvec3> region, at;
  std::string other;  // second operand of --diff; empty: --diff compares the passes
  std::optional<NumberRange> rows;
  bool stats = false, diff = false, run = false;
};

// Infers the stage from the other flags if --stage is not given.
void fill_in(DumpRequest& request) {
  const bool programs = request.diff && !request.other.empty();
  const bool bytecode = request.stats || request.program >= 0 || request.run || programs;
  const bool graph = (request.after && *request.after != compiler::pass_names().back()) || request.diff ||
                     request.format == kDot || request.format == kMermaid;
  if (request.stage < 0) request.stage = graph && !bytecode ? kGraph : kBytecode;
}

// Prints a message and returns an exit code if the flags do not go together.
std::optional<ExitCode> check_request(const DumpRequest& request, const Streams& streams) {
  const auto refuse = [&](std::string_view problem, const char* help) {
    return fail(streams, kUsage, problem, {help});
  };
  if (request.stage != kBytecode && (request.stats || request.program >= 0)) {
    return refuse(fmt::format("{} is about bytecode", request.stats ? "--stats" : "--program"),
                  "use it with --stage bytecode");
  }
  if (!request.other.empty() && !request.diff) {
    return refuse("a second scene is for --diff alone", "fathom dump --diff a.fbc b.fbc compares two programs");
  }
  if (request.diff && !request.other.empty() &&
      (request.stage != kBytecode || request.stats || request.run || request.region || request.format > kText)) {
    return refuse("--diff of two scenes compares their bytecode", "leave out all but --program and --after");
  }
  if (request.stage != kGraph && request.diff && request.other.empty()) {
    return refuse("--diff of one scene compares graphs",
                  "use it with --stage graph, and without --stats or --program");
  }
  if (request.run != request.at.has_value()) {
    return refuse("--run and --at go together", "fathom dump scene.fathom --run --at 0,1,0");
  }
  if (request.run && (request.stage != kBytecode || request.stats || request.region || request.format > kText)) {
    return refuse("--run is about bytecode, as text", "leave out --stage graph, --stats, --region and --format");
  }
  if (request.region && (request.stage != kBytecode || request.stats || request.after || request.format > kText)) {
    return refuse("--region lists the bytecode as it is run",
                  "leave out --stage graph, --after, --diff, --stats and --format");
  }
  if (request.region && request.program == 0) {
    return refuse("regions are made of the program that knows the objects", "leave out --program distance");
  }
  if ((request.stats || request.diff) && request.format > kText) {
    return refuse(fmt::format("{} is text", request.stats ? "--stats" : "--diff"), "leave out --format");
  }
  if (request.rows && (request.stage != kBytecode || request.run || request.stats || request.diff || request.region ||
                       request.format > kText)) {
    return refuse("--rows is about the listing of a program", "leave out all but --program and --after");
  }
  if (request.stage == kSyntax && request.format > kText) {
    return refuse("the syntax is printed as text only", "the scene file itself is the JSON");
  }
  if (request.stage == kFile && (request.format > kText || request.after)) {
    return refuse(fmt::format("--stage file is all of the compiled scene, as text; {} does not go with it",
                              request.after ? "--after" : "--format"),
                  "use --stage bytecode");
  }
  if (request.stage == kBytecode && request.format > kJson) {
    return refuse("bytecode is a sequence, not a graph to draw", "use --stage graph, or --format text or json");
  }
  if (request.stage == kSyntax && request.after) {
    return refuse("--after names a pass, and the syntax is what passes start from",
                  "use it with --stage graph or --stage bytecode");
  }
  return std::nullopt;
}

OptionResult read_rows(std::string_view text, NumberRange& rows) {
  return read_range(text, "rows", std::numeric_limits<std::uint32_t>::max(), rows);
}

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, DumpRequest& request) {
  Arguments arguments("dump", "Prints what the compiler made of a scene.", kDumpExamples);
  add_scene_arguments(arguments, request.scene);
  arguments.positional("other", "With --diff: the scene to compare with", request.other, false);
  arguments.option("--stage", "STAGE",
                   "Stage to print: syntax, graph, bytecode, or file, which is all that `fathom compile` writes "
                   "(bytecode, or graph with options about graphs)",
                   one_of({"syntax", "graph", "bytecode", "file"}, request.stage));
  arguments.option("--after", "PASS", "Stop after this pass of the compiler; graph stops before the first",
                   pass_name(request.after));
  arguments.option("--program", "PROGRAM", "Program to print: distance (default) or surface",
                   one_of({"distance", "surface"}, request.program));
  arguments.option("--format", "FORMAT", "Format: text (default) or json; graphs also dot and mermaid",
                   one_of({"text", "json", "dot", "mermaid"}, request.format));
  arguments.flag("--diff",
                 "Print what each pass changed in the graph of the distance and what that saved; of two scenes, the "
                 "differences between their programs",
                 request.diff);
  arguments.option("--region", "X,Y,Z", "Also print the part of the program that the region at this point runs",
                   into(read_point, request.region));
  arguments.option("--rows", "A:B",
                   "List rows A to B-1 of the instructions that repeat, and not only the first and last",
                   into(read_rows, request.rows));
  arguments.flag("--run", "Print the stacks after each instruction, in f32, at the point of --at", request.run);
  arguments.option("--at", "X,Y,Z", "Point of --run", into(read_point, request.at));
  arguments.flag("--stats", "Print the cost of operations and nodes, in multiply-adds per point", request.stats);
  if (const auto code = arguments.parse(args, streams)) return code;
  fill_in(request);
  return check_request(request, streams);
}

std::string print(const compiler::Scene& scene, const compiler::Source& source, int format) {
  if (format == kJson) return graph_json(scene, source);
  if (format == kDot) return graph_dot(scene, source);
  if (format == kMermaid) return graph_mermaid(scene, source);
  return print_graph(scene, source);
}

// Returns a comment with the scene position of the listing's origin, empty if that is 0.
std::string origin_line(const compiler::CompiledScene& scene) {
  const glm::dvec3 origin = scene.origin;
  return origin == glm::dvec3(0) ? "" : fmt::format("; origin {} {} {}\n", origin.x, origin.y, origin.z);
}

const vm::VerifiedProgram& program_of(const compiler::CompiledScene& scene, const DumpRequest& request) {
  return request.program == 1 ? scene.surface : scene.distance;
}

std::string print_bytecode(const compiler::CompiledScene& scene, const DumpRequest& request) {
  const char* name = request.program == 1 ? "surface" : "distance";
  const vm::VerifiedProgram& program = program_of(scene, request);
  if (request.run) {
    return fmt::format("; {}: {}\n", name, scene.summary) + origin_line(scene) +
           trace_listing(program, *request.at - scene.origin);
  }
  if (request.stats) {
    return fmt::format("{}\n{} of the graph\n\n{}", operation_table(program), count_of(scene.node_count, "node"),
                       cost_by_node(program));
  }
  if (request.format == kJson) return program_json(program, name, scene);
  return fmt::format("; {}: {}\n", name, scene.summary) + origin_line(scene) +
         vm::disassemble(program, {.few = true, .range = request.rows});
}

std::optional<ExitCode> check_length(const compiler::CompiledScene& scene, const DumpRequest& request,
                                     const Streams& streams) {
  if (!request.run || trace_work(program_of(scene, request)) <= kMaxTraceWork) return std::nullopt;
  return fail(streams, kUsage, "the program is too long to be run once for each of its instructions",
              {"--region lists the few of them that matter in the region at a point"});
}

// Prints the stages that need only the compiled scene, not the compilation.
std::string print_compiled(const compiler::CompiledScene& scene, const DumpRequest& request,
                           const compiler::FileContents& contents) {
  if (request.stage == kBytecode) return print_bytecode(scene, request);
  return compiler::write_listing(scene, contents);
}

// Prints the stages that need a compilation from the scene's text.
ExitCode dump_compiling(const DumpRequest& request, const compiler::Source& source, const Streams& streams) {
  std::string syntax;
  compiler::Scene graph;
  compiler::PassDiff diff(source);
  compiler::CompileOptions options;
  options.stop_after = request.after;
  if (request.stage == kSyntax) {
    options.on_syntax = [&](const compiler::ReadScene& read_as) { syntax = print_syntax(read_as.file); };
  } else if (request.diff) {
    options.on_pass = [&](std::string_view pass, const compiler::Scene& scene) { diff.add(pass, scene); };
  } else if (request.stage == kGraph) {
    options.on_pass = [&](std::string_view, const compiler::Scene& scene) { graph = scene; };
  }
  const auto compiled = compile_scene({source, std::nullopt}, request.scene, streams, options);
  if (request.stage == kSyntax) print(streams, syntax);  // also for a scene with errors
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  const auto& scene = std::get<compiler::CompiledScene>(compiled);
  if (request.diff && !request.after) diff.add_fused(scene.distance);
  if (request.stage == kGraph) {
    if (request.format <= kText) streams.out << origin_line(scene);
    cli::print(streams, request.diff ? diff.text() : print(graph, source, request.format));
  }
  if (request.region) {
    const std::optional<std::string> listing = region_listing(scene, *request.region);
    if (!listing) {
      return fail(
          streams, kBadScene,
          "the scene has no regions: it has no bounded part, its program cannot be cut, or cutting it takes too "
          "long");
    }
    streams.out << *listing;
  } else if (request.stage >= kBytecode) {
    if (const auto code = check_length(scene, request, streams)) return *code;
    streams.out << print_compiled(scene, request, {true, true, request.scene.definitions});
  }
  return kDone;
}

// Returns the compiled scene of one side of --diff a b, or the exit code after a message.
std::variant<compiler::CompiledScene, ExitCode> read_side(const DumpRequest& request, const std::string& path,
                                                          const Streams& streams) {
  SceneArguments arguments = request.scene;
  arguments.path = path;
  auto read = read_scene(arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  auto& input = std::get<SceneInput>(read);
  if (input.stored && !request.after && arguments.definitions.empty()) return std::move(input.stored->scene);
  compiler::CompileOptions options;
  options.stop_after = request.after;
  return compile_scene(std::move(input), arguments, streams, options);
}

ExitCode dump_difference(const DumpRequest& request, const Streams& streams) {
  const auto before = read_side(request, request.scene.path, streams);
  if (const auto* code = std::get_if<ExitCode>(&before)) return *code;
  const auto after = read_side(request, request.other, streams);
  if (const auto* code = std::get_if<ExitCode>(&after)) return *code;
  const auto side = [&](const std::string& name, const auto& scene) {
    return DiffSide{name, program_of(std::get<compiler::CompiledScene>(scene), request)};
  };
  cli::print(streams, program_diff(side(request.scene.path, before), side(request.other, after)));
  return kDone;
}

}  // namespace

int run_dump(std::span<const std::string> args, const Streams& streams) {
  DumpRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  if (!request.other.empty()) return dump_difference(request, streams);
  auto read = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  const SceneInput& input = std::get<SceneInput>(read);
  const bool as_stored =
      request.stage >= kBytecode && !request.after && !request.region && request.scene.definitions.empty();
  if (input.stored && as_stored) {
    if (const auto code = check_length(input.stored->scene, request, streams)) return *code;
    const compiler::StoredScene& stored = *input.stored;
    streams.out << print_compiled(request.stage == kFile ? stored.scene : as_claimed(stored.scene), request,
                                  stored.contents);
    return kDone;
  }
  if (input.stored && !input.stored->contents.text) {
    return fail(
        streams, kUsage,
        fmt::format("{} holds programs without the scene they were compiled from", cli::quoted(request.scene.path)),
        {"--stage bytecode and --stage file print what it holds"});
  }
  if (input.stored) {
    compiler::Definitions& own = request.scene.definitions;
    own.insert(own.begin(), input.stored->contents.definitions.begin(), input.stored->contents.definitions.end());
  }
  return dump_compiling(request, input.source, streams);
}

}  // namespace fathom::cli
