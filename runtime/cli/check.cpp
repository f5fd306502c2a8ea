// fathom check: every error and warning of a scene, and the exactness report: how far each object's distance can be
// trusted, how much of it a ray may step, and which node that is due to. --probe tries to refute it. No pixels.
// Tested by: tests/runtime/cli_test.cpp, tests/runtime/cli_check_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include "runtime/cli/check_report.h"
#include "runtime/cli/picture_warning.h"
#include "runtime/cli/scene_file.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kCheckExamples =
    "fathom check scene.json\n"
    "fathom check scenes/*.json                     # the worst is the status\n"
    "fathom check --error-format short scene.json   # a line per error\n"
    "fathom check --error-format json scene.json    # JSON lines\n"
    "fathom check --probe 1000000 scene.json        # tests the Lipschitz constants";

constexpr int kMostProbes = 100'000'000;

struct CheckRequest {
  SceneArguments scene;
  std::vector<std::string> paths;
  std::optional<int> probes, threads;
};

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, CheckRequest& request) {
  Arguments arguments("check",
                      "Prints every error and warning of scenes and how exact their distances are. Renders nothing.",
                      kCheckExamples);
  request.scene.count_warnings = true;
  request.scene.inspect = warn_of_empty_view;
  add_scene_arguments(arguments, request.scene, request.paths);
  arguments.option("--probe", "N",
                   "Compare gradients and differences at N points with the constants that the compiler proved",
                   whole(request.probes, 1, kMostProbes));
  arguments.option("--threads", "N", "Number of threads of --probe (one per processor)",
                   whole(request.threads, 1, 1024));
  return arguments.parse(args, streams);
}

// Prints what the probes saw; kFoundProblems when they refute anything.
ExitCode run_probe(const CheckRequest& request, const compiler::CompiledScene& scene, const compiler::Scene& graph,
                   const Streams& streams) {
  compiler::ProbeOptions options;
  options.points = static_cast<std::uint64_t>(*request.probes);
  options.reach = 10 * glm::length(scene.camera.target - scene.camera.position);
  options.origin = scene.origin;
  options.threads = request.threads.value_or(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  const std::vector<compiler::ProbeRow> rows = probe(graph, scene.surfaces, options);
  const std::vector<const compiler::ProbeRow*> culprits = compiler::culprits(graph, rows);
  const bool json = static_cast<compiler::ErrorFormat>(request.scene.error_format) == compiler::ErrorFormat::Json;
  print(streams, json ? probe_json(scene.source, rows, culprits) : probe_text(scene.source, rows, culprits));
  return culprits.empty() ? kDone : kFoundProblems;
}

ExitCode check_scene(const CheckRequest& request, const Streams& streams) {
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  compiler::Scene graph;
  compiler::CompileOptions options;
  options.lint = true;
  options.on_pass = [&](std::string_view pass, const compiler::Scene& stage) {
    if (pass == "graph") graph = stage;
  };
  const auto compiled = compile_scene(std::get<SceneInput>(std::move(source)), request.scene, streams, options);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code == kBadScene ? kFoundProblems : *code;

  const auto& scene = std::get<compiler::CompiledScene>(compiled);
  const compiler::Report report = make_report(graph, scene.surfaces);
  const bool json = static_cast<compiler::ErrorFormat>(request.scene.error_format) == compiler::ErrorFormat::Json;
  if (!streams.quiet) print(streams, json ? report_json(scene, report) : report_text(scene, report));
  return request.probes ? run_probe(request, scene, graph, streams) : kDone;
}

}  // namespace

int run_check(std::span<const std::string> args, const Streams& streams) {
  CheckRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  const bool text = static_cast<compiler::ErrorFormat>(request.scene.error_format) == compiler::ErrorFormat::Text;
  ExitCode worst = kDone;
  for (std::size_t i = 0; i < request.paths.size(); ++i) {
    request.scene.path = request.paths[i];
    if (request.paths.size() > 1 && text && !streams.quiet) {
      print(streams, fmt::format("{}{}:\n", i > 0 ? "\n" : "", source_name(request.scene.path)));
      streams.out.flush();
    }
    worst = std::max(worst, check_scene(request, streams));  // larger is worse
  }
  return worst;
}

}  // namespace fathom::cli
