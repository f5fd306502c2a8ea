#include "compiler/compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

#include "compiler/analysis/area_lights.h"
#include "compiler/analysis/extent.h"
#include "compiler/analysis/lints.h"
#include "compiler/analysis/nan_regions.h"
#include "compiler/analysis/origin.h"
#include "compiler/derive/derive.h"
#include "compiler/field_compiler.h"
#include "compiler/frontend/elaborate/elaborate.h"
#include "compiler/frontend/read_scene.h"
#include "compiler/frontend/stage.h"
#include "compiler/graph/rewrite.h"
#include "compiler/lower/lower.h"
#include "compiler/passes/passes.h"
#include "compiler/passes/signs.h"
#include "compiler/scene/framing.h"
#include "compiler/shapes/blends.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"
#include "vm/number/decimal.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {
namespace {

// Makes a camera that the scene does not place frame the whole scene.
void place_camera(ElaboratedScene& elaborated, const Box& extent) {
  const Film& film = elaborated.film;
  elaborated.camera = placed(elaborated.camera, extent, static_cast<double>(film.width) / film.height);
}

// Moves all places of the scene to the programs' coordinates. Returns the origin.
glm::dvec3 move_to_origin(ElaboratedScene& elaborated, const std::vector<NodeFacts>& known,
                          const std::optional<glm::dvec3>& given) {
  const glm::dvec3 origin = given ? *given : choose_origin(elaborated.scene, known, elaborated.camera);
  if (origin == glm::dvec3(0)) return origin;
  elaborated.scene = moved(elaborated.scene, origin, elaborated.surfaces);
  elaborated.camera.position -= origin;
  elaborated.camera.target -= origin;
  for (Light& light : elaborated.lights) light.position -= origin;
  return origin;
}

// Looks for the file of the background image, whose path is relative to the scene's folder.
void find_files(ElaboratedScene& elaborated, const Source& source, const std::string& at_hand,
                Diagnostics& diagnostics) {
  namespace fs = std::filesystem;
  Background::Image& image = elaborated.background.image;
  if (elaborated.background.type != Background::Type::Image) return;
  const fs::path path = fs::path(source.name()).parent_path() / image.file;
  image.file = path.string();
  if (!at_hand.empty() && image.file == at_hand) return;
  std::error_code error;
  if (fs::is_regular_file(path, error)) {
    std::string ending = path.extension().string();
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (ending == ".hdr" || ending == ".exr") return;
    diagnostics.error("E0311", image.span, fmt::format("`{}` is no picture of light", image.file), "",
                      {"a background is a .hdr or .exr file: others hold no more than a screen's brightness"});
    return;
  }
  diagnostics.error("E0311", image.span,
                    fmt::format("cannot read `{}`: {}", image.file, error ? error.message() : "it is not a file"), "",
                    {"a path in a scene begins at the scene's own folder"});
}

// True if tags are needed to tell surfaces apart, or to map a point to the coordinates of its node.
bool needs_tags(std::span<const Surface> surfaces) {
  return surfaces.size() > 1 || std::any_of(surfaces.begin(), surfaces.end(), std::mem_fn(&Surface::placed));
}

std::size_t count_nodes(const Scene& scene) {
  std::size_t count = 0;
  for (bool reached : reachable(scene)) count += reached;
  return count;
}

std::string summarise(std::size_t nodes, NodeFacts known, bool in_cells, glm::dvec3 origin) {
  known.box = known.box.moved(origin);
  return fmt::format("{} {}, {}", nodes, nodes == 1 ? "node" : "nodes", describe(known, in_cells));
}

// Warns when the float error of distances near the surface exceeds a ten-thousandth of the distance from the camera
// to its target.
// `cancellation`: of the compiled field.
void warn_of_cancellation(const Scene& scene, const std::vector<NodeFacts>& known, double cancellation,
                          const Camera& camera, Diagnostics& diagnostics) {
  const double error = vm::kFloatError * cancellation;
  const double most = 1e-4 * glm::length(camera.target - camera.position);
  // Marching allows for numbers up to 1 everywhere (runtime/field/field.h).
  if (error <= most || cancellation <= 1) return;
  NodeId worst = scene.root;
  for (NodeId child : scene.graph.children(scene.root)) {
    if (known[child].cancellation == cancellation) worst = child;
  }
  diagnostics.warning(
      "W0403", scene.graph.origin(worst).span,
      fmt::format("numbers around {:.3g} cancel here: in float its surface is known to {:.1g}", cancellation, error),
      "", {"use a plane for a wide floor; keep large moves from cancelling; blend and round less"});
}

// Warns when the scene's contents and the camera lie so close together that double, which decides what float cannot,
// has an error above a thousandth of a pixel.
void warn_of_smallness(const Scene& scene, const std::vector<NodeFacts>& known, const Camera& camera,
                       Diagnostics& diagnostics) {
  constexpr double kLeast = 1e-7;
  const Box box = contents(scene.graph, scene.root, known);
  if (box.empty()) return;
  const double size = std::max(glm::length(box.hi - box.lo), glm::length((box.lo + box.hi) * 0.5 - camera.position));
  if (!(size < kLeast)) return;
  Span span = scene.graph.origin(scene.root).span;
  if (span.end == 0 && !scene.graph.children(scene.root).empty()) {
    span = scene.graph.origin(scene.graph.children(scene.root)[0]).span;
  }
  const auto exponent = static_cast<int>(std::round(-vm::real::log10(std::max(size, 1e-300))));
  diagnostics.warning("W0513", span,
                      fmt::format("the scene is too small: {:.2g} from end to end, camera and all", size),
                      "errors shrink with places down to those around 1, and no further",
                      {fmt::format("multiply every length by {:.0e}, those of the camera too; pictures stay the same",
                                   vm::real::power_of_ten(exponent))});
}

}  // namespace

std::optional<CompiledScene> compile(Source source, Diagnostics& diagnostics, const CompileOptions& options) {
  std::optional<ReadScene> read =
      read_scene(source, diagnostics, options.limits, options.definitions, options.imports);
  if (options.on_source) options.on_source(source);
  if (!read) return std::nullopt;
  if (options.stage && wants_stage(*read)) {
    CompileOptions bare;
    bare.limits = options.limits;
    Diagnostics ignored;  // the staged model has the same diagnostics
    if (const std::optional<CompiledScene> model = compile(source, ignored, bare)) set_stage(*read, *model);
  }
  if (options.on_syntax) options.on_syntax(*read);
  std::optional<ElaboratedScene> elaborated =
      elaborate(read->file, diagnostics, options.definitions, options.limits, std::move(read->parameters));
  if (!elaborated) return std::nullopt;
  std::optional<Scene> derived = derive(elaborated->scene, elaborated->type_spans, options.limits, diagnostics);
  if (!derived) return std::nullopt;
  elaborated->scene = *std::move(derived);
  read.reset();  // frees memory for the remaining steps: 120 MB for 200,000 balls
  find_files(*elaborated, source, options.file_at_hand, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;

  if (options.on_pass) options.on_pass(kGraph, elaborated->scene);
  const std::vector<NodeFacts> known_before = analyse(elaborated->scene.graph);
  Box whole_extent = extent(elaborated->scene, known_before);
  place_camera(*elaborated, whole_extent);
  const glm::dvec3 origin =
      options.stop_after == kGraph ? glm::dvec3(0) : move_to_origin(*elaborated, known_before, options.origin);
  whole_extent = whole_extent.moved(-origin);
  place_camera(*elaborated, whole_extent);
  const Scene field = optimise(elaborated->scene, false, options.stop_after, options.on_pass);
  const std::vector<NodeFacts> known = analyse(field.graph);
  const FieldCompiler fields{
      source, options.limits, options.stop_after, options.pieces, needs_tags(elaborated->surfaces), diagnostics};
  std::optional<SplitField> whole =
      fields.compile(field, fields.needs_paint() ? optimise(elaborated->scene, true, options.stop_after) : field);
  if (!whole) return std::nullopt;
  leave_solids(elaborated->camera, whole->distance);
  std::optional<std::vector<Medium>> media = fields.compile_media(*elaborated);
  if (!media) return std::nullopt;
  std::optional<std::vector<vm::VerifiedProgram>> formulas = fields.compile_formulas(elaborated->formulas);
  if (!formulas) return std::nullopt;

  warn_of_cancellation(field, known, whole->cancellation, elaborated->camera, diagnostics);
  warn_of_smallness(field, known, elaborated->camera, diagnostics);
  warn_of_unbounded_formulas(elaborated->scene, diagnostics);
  if (options.lint) {
    lint(elaborated->scene, *elaborated, whole->surface, diagnostics);
    lint_offsets(elaborated->scene, diagnostics);
    lint_places(elaborated->scene, origin, diagnostics);
    warn_of_nan(elaborated->scene, *whole, *elaborated, origin, source, diagnostics);
  }
  if (options.lint || options.lint_picture) lint_light(elaborated->scene, *elaborated, whole->surface, diagnostics);
  mark_mixed(elaborated->scene, elaborated->materials, elaborated->surfaces);
  std::vector<AreaLight> area_lights =
      find_area_lights(elaborated->scene, elaborated->surfaces, elaborated->materials);
  CompiledScene result{static_cast<SceneTables&&>(*elaborated),
                       std::move(*whole),
                       std::move(source),
                       origin,
                       whole_extent,
                       std::move(*media),
                       std::move(area_lights),
                       std::move(*formulas),
                       count_nodes(field),
                       ""};
  const bool in_cells = !result.certified && !result.formula_box.empty();
  result.summary = summarise(result.node_count, known[field.root], in_cells, origin);
  return result;
}

void restore_pieces(CompiledScene& stored, const Definitions& definitions, const Limits& limits) {
  CompileOptions options;
  options.limits = limits;
  options.definitions = definitions;
  options.file_at_hand = stored.background.image.file;
  options.pieces = true;
  options.origin = stored.origin;
  Diagnostics ignored;  // those of the compilation that made the file
  std::optional<CompiledScene> scene = compile(stored.source, ignored, options);
  const auto words = [](const CompiledField& of) { return of.surface.program().words; };
  if (!scene || words(*scene) != words(stored) || !std::ranges::equal(scene->media, stored.media, {}, words, words))
    return;
  stored.pieces = std::move(scene->pieces);
  for (std::size_t i = 0; i < stored.media.size(); ++i) stored.media[i].pieces = std::move(scene->media[i].pieces);
}

std::optional<GraphSize> measure(const Scene& scene, const Source& source, const Limits& limits) {
  Diagnostics ignored;
  const std::optional<std::string> stop_after = std::string(kGraph);
  const std::optional<vm::VerifiedProgram> program =
      FieldCompiler{source, limits, stop_after, false, false, ignored}.assemble(scene);
  if (!program) return std::nullopt;
  return GraphSize{count_nodes(scene), program->instructions(), program->cost()};
}

std::vector<std::string_view> pass_names() {
  std::vector<std::string_view> names = {kOrigin};
  for (const Pass& pass : passes()) names.push_back(pass.name);
  names.push_back(kFuse);
  return names;
}

}  // namespace fathom::compiler
