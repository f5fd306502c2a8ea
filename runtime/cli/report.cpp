// fathom report: writes a page about a scene that needs nothing else: picture, live view, source, program, costs.
// Tested by: tests/runtime/cli/cli_report_test.cpp
#include "compiler/analysis/report.h"

#include <fmt/format.h>

#include <filesystem>
#include <ostream>
#include <sstream>

#include "runtime/cli/input/text_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/picture/prepared_render.h"
#include "runtime/cli/picture/progress.h"
#include "runtime/cli/report/report_page.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kReportExamples =
    "fathom report scene.fathom -o report.html\n"
    "fathom report scene.fathom -o report.html --spp 256 --size 1280x720\n"
    "fathom chart scene.fathom -o chart && fathom report scene.fathom -o report.html --chart chart/chart.svg";

struct ReportRequest {
  RenderRequest render;
  std::optional<std::string> output, chart;
};

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, ReportRequest& request) {
  Arguments arguments("report",
                      "Writes a page about the scene: its picture, a live view, its source, the compiler's report, "
                      "the program and its costs. The page is one file and needs no network.",
                      kReportExamples);
  RenderRequest& render = request.render;
  add_scene_arguments(arguments, render.scene);
  arguments.option("-o,--output", "FILE", "File to write (the scene's name with .html)", any_text(request.output));
  arguments.option("-s,--spp", "N", "Samples per pixel (the scene's)", whole(render.options.spp, 1, 1 << 20));
  arguments.option("--size", "WxH", "Size of the picture (the scene's)", into(read_size, render.size));
  arguments.option("--threads", "N", "Threads that render (one per processor)",
                   whole(render.options.threads, 1, 1024));
  arguments.option("--chart", "FILE", "SVG file of `fathom chart` to include", any_text(request.chart));
  if (const auto code = arguments.parse(args, streams)) return code;
  if (!request.output) {
    if (render.scene.path == "-") return fail(streams, kUsage, "no file to write", {"add -o report.html"});
    request.output = std::filesystem::path(render.scene.path).stem().string() + ".html";
  }
  if (const auto code = check_text_output(request.output, streams)) return code;
  render.quiet = true;
  render.options.profile = true;
  render.options.layers = runtime::kAllLayers;
  return std::nullopt;
}

// Returns the compiler's report, which is about the graph before the first pass.
std::variant<compiler::Report, ExitCode> report_of(const PreparedRender& picture, const SceneInput& input,
                                                   std::ostream& messages, const Streams& streams) {
  compiler::Scene graph;
  compiler::CompileOptions options;
  options.stage = true;
  const auto compiled = compile_checked({input.source, std::nullopt}, picture.request.scene, graph,
                                        {streams.in, messages, messages}, std::move(options));
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  return make_report(graph, std::get<compiler::CompiledScene>(compiled).surfaces);
}

runtime::RenderResult render(PreparedRender& picture, const Streams& streams) {
  if (streams.quiet || !streams.shows_steps) return runtime::render(picture.scene, picture.request.options);
  ProgressLine line(streams);
  picture.request.options.on_progress = [&](const runtime::Progress& progress) { line.update(progress); };
  return runtime::render(picture.scene, picture.request.options);
}

std::string command_of(std::span<const std::string> args) {
  std::string command = "fathom report";
  for (const std::string& arg : args) command += ' ' + arg;
  return command;
}

}  // namespace

int run_report(std::span<const std::string> args, const Streams& streams) {
  ReportRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  std::optional<std::string> chart;
  if (request.chart) {
    auto read = read_text(*request.chart, request.render.scene.limits, streams);
    if (const auto* error = std::get_if<ReadError>(&read)) return fail(streams, *request.chart, *error);
    chart = std::get<std::string>(std::move(read));
  }
  const auto read = read_scene(request.render.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  const auto& input = std::get<SceneInput>(read);
  if (input.source.text().empty()) {
    return fail(streams, kUsage, "the file holds programs without the scene they were compiled from",
                {"give the scene's own file"});
  }
  RenderCache cache;
  const auto prepared = prepare_render(request.render, input, cache, streams);
  if (const auto* code = std::get_if<ExitCode>(&prepared)) return *code;
  PreparedRender& picture = *std::get<std::unique_ptr<PreparedRender>>(prepared);
  std::ostringstream messages;
  const auto report = report_of(picture, input, messages, streams);
  if (const auto* code = std::get_if<ExitCode>(&report)) {
    streams.err << messages.str();
    return *code;
  }
  const runtime::RenderResult result = render(picture, streams);
  const std::string page = report_page({picture.scene, std::get<compiler::Report>(report), result, command_of(args),
                                        std::move(messages).str(), chart});
  return write_text_output(page, request.output, streams);
}

}  // namespace fathom::cli
