#include "runtime/cli/view/listings.h"

#include <sstream>

#include "compiler/analysis/report.h"
#include "compiler/pass_diff.h"
#include "compiler/shapes/print_graph.h"
#include "runtime/cli/dump/check_report.h"
#include "runtime/cli/dump/region_listing.h"
#include "runtime/cli/dump/trace_listing.h"

namespace fathom::cli {
namespace {

// Compiles the scene's text again with `options`, which collect what is wanted on the way.
Listing compile_again(const LoadedScene& loaded, compiler::CompileOptions options) {
  std::istringstream in;
  std::ostringstream out, err;
  options.stage = true;
  const auto compiled = compile_scene({loaded.input.source, std::nullopt}, loaded.arguments, {in, out, err}, options);
  if (std::holds_alternative<ExitCode>(compiled)) return {422, std::move(err).str()};
  return {200, ""};
}

Listing list_passes(const LoadedScene& loaded) {
  compiler::PassDiff diff(loaded.scene().source);
  compiler::CompileOptions options;
  options.on_pass = [&](std::string_view pass, const compiler::Scene& scene) { diff.add(pass, scene); };
  Listing listing = compile_again(loaded, std::move(options));
  if (listing.status != 200) return listing;
  diff.add_fused(loaded.scene().distance);
  return {200, diff.text()};
}

Listing list_graph(const LoadedScene& loaded) {
  compiler::Scene graph;
  compiler::CompileOptions options;
  options.on_pass = [&](std::string_view, const compiler::Scene& scene) { graph = scene; };
  Listing listing = compile_again(loaded, std::move(options));
  if (listing.status != 200) return listing;
  return {200, print_graph(graph, loaded.scene().source)};
}

Listing list_check(const LoadedScene& loaded) {
  compiler::Scene graph;
  compiler::CompileOptions options;
  options.stage = true;
  std::istringstream in;
  std::ostringstream messages;
  const auto compiled = compile_checked({loaded.input.source, std::nullopt}, loaded.arguments, graph,
                                        {in, messages, messages}, std::move(options));
  const auto* scene = std::get_if<compiler::CompiledScene>(&compiled);
  if (!scene) return {422, std::move(messages).str()};
  return {200, std::move(messages).str() + report_text(*scene, make_report(graph, scene->surfaces), true)};
}

Listing list_run(const compiler::CompiledScene& scene, glm::dvec3 point) {
  if (trace_work(scene.surface) > kMaxTraceWork) {
    return {422, "the program is too long to be run once for each of its instructions"};
  }
  return {200, trace_listing(scene.surface, point - scene.origin)};
}

Listing list_region(const compiler::CompiledScene& scene, glm::dvec3 point) {
  if (auto text = region_listing(scene, point)) return {200, std::move(*text)};
  return {422, "the scene has no regions: it has no bounded part, or its program cannot be divided"};
}

}  // namespace

Listing make_listing(const LoadedScene& loaded, std::string_view kind, std::optional<glm::dvec3> point) {
  const bool has_text = !loaded.input.source.text().empty();
  if (kind == "passes" || kind == "graph" || kind == "check") {
    if (!has_text) return {422, "the file holds programs without the scene they were compiled from"};
    return kind == "passes" ? list_passes(loaded) : kind == "graph" ? list_graph(loaded) : list_check(loaded);
  }
  if (kind != "run" && kind != "region") return {400, "kind is one of passes, graph, check, run, region"};
  if (!point) return {400, "at=X,Y,Z is missing"};
  return kind == "run" ? list_run(loaded.scene(), *point) : list_region(loaded.scene(), *point);
}

}  // namespace fathom::cli
