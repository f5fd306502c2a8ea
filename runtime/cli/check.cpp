// fathom check: prints every error and warning of a scene and the exactness report. The report tells per object how
// far its distance can be trusted, which fraction of the distance a ray may step, and which node is responsible.
// --probe tries to refute the report. No image is rendered.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/cli_check_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/machine.h"
#include "runtime/cli/dump/check_report.h"
#include "runtime/cli/frames/scene_frames.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/options/buffered_messages.h"
#include "runtime/cli/options/frame_options.h"
#include "runtime/cli/picture/image_warning.h"
#include "runtime/cli/verbs.h"
#include "runtime/sampling/shutter.h"

namespace fathom::cli {
namespace {

constexpr const char* kCheckExamples =
    "fathom check scene.fathom\n"
    "fathom check scenes/*.json                     # the worst is the status\n"
    "fathom check --error-format short scene.fathom # a line per error\n"
    "fathom check --error-format json scene.fathom  # JSON lines\n"
    "fathom check --frames 0:192 hop.fathom         # each frame of an animation\n"
    "fathom check --probe 1000000 scene.fathom      # tests the Lipschitz constants";

constexpr int kMaxProbes = 100'000'000;

struct CheckRequest {
  SceneArguments scene;
  std::vector<std::string> paths;
  std::optional<int> probes, threads;
  FrameOptions frames;
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
                   whole(request.probes, 1, kMaxProbes));
  arguments.option("--threads", "N", "Number of threads of --probe (one per processor)",
                   whole(request.threads, 1, 1024));
  add_frame_options(arguments, request.frames);
  if (const auto code = arguments.parse(args, streams)) return code;
  if (!request.probes || !request.frames.given()) return std::nullopt;
  return fail(streams, kUsage, "--probe does not go with --frames: it looks at one moment for long",
              {"choose the moment with -D time=1.5"});
}

// Prints the results of the probes. Returns kFoundProblems if they refute a constant.
ExitCode run_probe(const CheckRequest& request, const compiler::CompiledScene& scene, const compiler::Scene& graph,
                   const Streams& streams) {
  compiler::ProbeOptions options;
  options.points = static_cast<std::uint64_t>(*request.probes);
  options.reach = 10 * glm::length(scene.camera.target - scene.camera.position);
  options.origin = scene.origin;
  options.threads = request.threads ? *request.threads : runtime::usable_processors();
  const std::vector<compiler::ProbeRow> rows = probe(graph, scene.surfaces, options);
  const std::vector<const compiler::ProbeRow*> culprits = compiler::culprits(graph, rows);
  const bool json = static_cast<compiler::ErrorFormat>(request.scene.error_format) == compiler::ErrorFormat::Json;
  print(streams, json ? probe_json(scene.source, rows, culprits) : probe_text(scene.source, rows, culprits));
  return culprits.empty() ? kDone : kFoundProblems;
}

// Compiles the scene for the report: errors in it are problems found.
std::variant<compiler::CompiledScene, ExitCode> compile_for_report(const SceneInput& input,
                                                                   const SceneArguments& arguments,
                                                                   compiler::Scene& graph, const Streams& streams) {
  auto compiled = compile_checked(input, arguments, graph, streams);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code == kBadScene ? kFoundProblems : *code;
  return compiled;
}

void print_report(const CheckRequest& request, const compiler::CompiledScene& scene, const compiler::Scene& graph,
                  const Streams& streams) {
  if (streams.quiet) return;
  const compiler::Report report = make_report(graph, scene.surfaces);
  const bool json = static_cast<compiler::ErrorFormat>(request.scene.error_format) == compiler::ErrorFormat::Json;
  print(streams, json ? report_json(scene, report) : report_text(scene, report, streams.verbosity > 0));
}

ExitCode check_moment(const CheckRequest& request, const SceneInput& input, const Streams& streams) {
  compiler::Scene graph;
  const auto compiled = compile_for_report(input, request.scene, graph, streams);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  const auto& scene = std::get<compiler::CompiledScene>(compiled);
  print_report(request, scene, graph, streams);
  return request.probes ? run_probe(request, scene, graph, streams) : kDone;
}

// Compiles the scene at the moments of a frame's open shutter, with the scene's own settings. Returns false, after
// messages, if the scene has errors at one of them.
bool check_shutter(const SceneInput& input, const SceneArguments& frame, const compiler::CompiledScene& scene,
                   const Sequence& sequence, int number, const Streams& streams) {
  if (!(scene.camera.shutter > 0) || !sequence.animation.time) return true;
  const double open = scene.camera.shutter / sequence.fps;
  for (const runtime::ShutterInterval& run :
       runtime::shutter_intervals(scene.settings.spp, runtime::kDefaultShutterTimes, scene.settings.seed, number)) {
    SceneArguments moment = frame;
    moment.definitions.emplace_back(compiler::kTimeParameter, sequence.time_of(number) + open * run.time);
    moment.inspect = nullptr;
    BufferedMessages held(streams);
    if (std::holds_alternative<compiler::CompiledScene>(compile_scene(input, moment, held.streams()))) continue;
    held.release();
    return false;
  }
  return true;
}

// Prints the report of the first frame without errors, and counts the frames with errors.
ExitCode check_frames(const CheckRequest& request, SceneInput& input, const Streams& streams) {
  const auto asked = sequence_of(request.frames, input, request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&asked)) return *code == kBadScene ? kFoundProblems : *code;
  const auto& sequence = std::get<Sequence>(asked);
  std::string last;
  std::vector<int> bad;
  bool reported = false;
  for (int index = 0; index < sequence.frames.count(); ++index) {
    const int frame = sequence.frames.at(index);
    const SceneArguments arguments = sequence.at(request.scene, frame);
    compiler::Scene graph;
    BufferedMessages held(streams);
    const auto compiled = compile_for_report(input, arguments, graph, held.streams());
    held.release_if_new(last);
    const auto* scene = std::get_if<compiler::CompiledScene>(&compiled);
    if (scene && !std::exchange(reported, true)) print_report(request, *scene, graph, streams);
    if (scene && check_shutter(input, arguments, *scene, sequence, frame, streams)) continue;
    fail_about(arguments, kFoundProblems, fmt::format("{} has errors", sequence.describe(frame)), {}, streams);
    bad.push_back(frame);
  }
  const bool text = static_cast<compiler::ErrorFormat>(request.scene.error_format) == compiler::ErrorFormat::Text;
  if (text && !streams.quiet) {
    print(streams, fmt::format("{} checked, {} with errors\n",
                               count_of(static_cast<std::size_t>(sequence.frames.count()), "frame"), bad.size()));
  }
  return bad.empty() ? kDone : kFoundProblems;
}

ExitCode check_scene(const CheckRequest& request, const Streams& streams) {
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  auto& input = std::get<SceneInput>(source);
  return request.frames.given() ? check_frames(request, input, streams) : check_moment(request, input, streams);
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
    worst = std::max(worst, check_scene(request, streams));  // a larger exit code is worse
  }
  return worst;
}

}  // namespace fathom::cli
