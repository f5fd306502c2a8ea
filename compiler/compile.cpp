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
#include "compiler/analysis/formula_cells.h"
#include "compiler/analysis/lints.h"
#include "compiler/analysis/media.h"
#include "compiler/analysis/nan_regions.h"
#include "compiler/analysis/origin.h"
#include "compiler/derive/derive.h"
#include "compiler/frontend/elaborate/elaborate.h"
#include "compiler/frontend/read_scene.h"
#include "compiler/frontend/stage.h"
#include "compiler/geometry/fits_float.h"
#include "compiler/graph/rewrite.h"
#include "compiler/lower/fuse.h"
#include "compiler/lower/lower.h"
#include "compiler/passes/passes.h"
#include "compiler/passes/signs.h"
#include "compiler/passes/split.h"
#include "compiler/scene/framing.h"
#include "compiler/shapes/blends.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"
#include "vm/number/decimal.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {
namespace {

using OnPass = std::function<void(std::string_view, const Scene&)>;

constexpr std::string_view kGraph = "graph";    // the graph as read
constexpr std::string_view kOrigin = "origin";  // the first step (compiler/analysis/origin.h)
constexpr std::string_view kFuse = "fuse";      // the last step, over programs

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

Scene optimise(Scene scene, bool keep_paint, const CompileOptions& options, const OnPass& on_pass) {
  if (options.stop_after == kGraph) return scene;
  if (on_pass) on_pass(kOrigin, scene);
  if (options.stop_after == kOrigin) return scene;
  for (const Pass& pass : passes()) {
    if (!(keep_paint && pass.run == strip)) scene = pass.run(scene);
    if (on_pass) on_pass(pass.name, scene);
    if (options.stop_after == pass.name) break;
  }
  return scene;
}

bool leaves_float(const Instruction& instruction) {
  return !std::all_of(instruction.immediates.begin(), instruction.immediates.end(), fits_float);
}

// Returns the first node whose code has immediates beyond the range of float.
std::optional<NodeId> node_beyond_float(const Scene& scene) {
  const std::vector<bool> reached = reachable(scene);
  for (NodeId id = 0; id < scene.graph.size(); ++id) {
    if (!reached[id]) continue;
    const Code code = spec(scene.graph.kind(id)).code(scene.graph.params(id));
    bool leaves = std::any_of(code.after.begin(), code.after.end(), leaves_float);
    for (const auto& chain : code.points) leaves = leaves || std::any_of(chain.begin(), chain.end(), leaves_float);
    if (leaves) return id;
  }
  return std::nullopt;
}

void report_unsound(const Scene& scene, const vm::VerifyError& error, Diagnostics& diagnostics) {
  if (const std::optional<NodeId> node = node_beyond_float(scene)) {
    diagnostics.error("E0308", scene.graph.origin(*node).span,
                      fmt::format("evaluating this takes numbers beyond those of float ({})", error.reason), "",
                      {"float ends at 3.4e38: make the node's parameters less extreme"});
    return;
  }
  diagnostics.error("E0305", scene.graph.origin(scene.root).span,
                    fmt::format("no machine runs the scene's program: {}", error.reason), "",
                    {"make the scene smaller, or cut it into several"});
}

std::optional<vm::VerifiedProgram> assemble(const Scene& scene, const Source& source, bool fused,
                                            const Limits& limits, Diagnostics& diagnostics) {
  const auto most = static_cast<std::size_t>(limits.instructions);
  std::optional<vm::Program> program = lower(scene.graph, scene.root, source, most);
  if (!program) {
    diagnostics.error("E0305", scene.graph.origin(scene.root).span,
                      fmt::format("the scene needs more than {} instructions", most), "",
                      {"a node used under different transforms is evaluated once for each; use it less often",
                       raise(&Limits::instructions, 2 * limits.instructions)});
    return std::nullopt;
  }
  auto verified = vm::verify(fused ? fuse(std::move(*program)) : std::move(*program), largest_machine());
  if (const auto* error = std::get_if<vm::VerifyError>(&verified)) {
    report_unsound(scene, *error, diagnostics);
    return std::nullopt;
  }
  auto& sound = std::get<vm::VerifiedProgram>(verified);
  if (auto excess = excess_of(sound, limits)) {
    diagnostics.error("E0305", scene.graph.origin(scene.root).span, std::move(excess->what), "",
                      {std::move(excess->remedy)});
    return std::nullopt;
  }
  return std::move(sound);
}

// True if tags are needed to tell surfaces apart, or to map a point to the coordinates of its node.
bool needs_tags(std::span<const Surface> surfaces) {
  return surfaces.size() > 1 || std::any_of(surfaces.begin(), surfaces.end(), std::mem_fn(&Surface::placed));
}

// `scene` and `optimised` are the scene after the passes, with and without Paint, and `known` are the latter's facts.
// `painted` is true if the surface program needs tags.
std::optional<CompiledField> compile_field(const Scene& scene, const Scene& optimised,
                                           const std::vector<NodeFacts>& known, bool painted, const Source& source,
                                           Diagnostics& diagnostics, const CompileOptions& options) {
  const bool fused = options.stop_after.value_or(std::string(kFuse)) == kFuse;
  std::optional<vm::VerifiedProgram> distance = assemble(optimised, source, fused, options.limits, diagnostics);
  if (!distance) return std::nullopt;
  std::optional<vm::VerifiedProgram> surface = distance;
  if (painted) surface = assemble(scene, source, fused, options.limits, diagnostics);
  if (!surface) return std::nullopt;
  const NodeFacts& all = known[optimised.root];
  const FormulaCells cells =
      formula_cells(optimised.graph, optimised.root, known).value_or(FormulaCells{{}, 0, all.cancellation});
  return CompiledField{
      std::move(*distance), std::move(*surface), all.box,       contents(optimised.graph, optimised.root, known),
      all.lipschitz,        cells.cancellation,  all.certified, cells.box,
      cells.rest_lipschitz};
}

// Takes the factor from the root by which `normalise` made it as flat as its neighbours: alone it needs none, and its
// roots are known the better the steeper it is.
Scene without_level(Scene scene) {
  const Graph& graph = scene.graph;
  const bool painted = graph.kind(scene.root) == Kind::Paint;
  const NodeId top = painted ? graph.children(scene.root)[0] : scene.root;
  if (graph.kind(top) != Kind::Scaled) return scene;
  const NodeId inner = graph.children(top)[0];
  if (analyse(graph)[inner].lipschitz <= 1) return scene;
  const NodeId paint = scene.root;
  const NodeId only[] = {inner};
  scene.root = painted ? scene.graph.add(Kind::Paint, graph.params(paint), only, graph.origin(paint)) : inner;
  return scene;
}

// Compiles the pieces of a scene, none if it is one piece or too many: `optimised` is the scene after the passes,
// with Paint.
std::optional<std::vector<CompiledPiece>> compile_pieces(const Scene& optimised, bool painted, const Source& source,
                                                         Diagnostics& diagnostics, const CompileOptions& options) {
  std::vector<CompiledPiece> pieces;
  constexpr std::size_t kMostPieces = 1 << 15;  // each of some kilobytes
  const Pieces parts = split(optimised);
  if (parts.nodes.size() < 2 || parts.nodes.size() > kMostPieces) return pieces;
  for (const NodeId node : parts.nodes) {
    const Scene surface = fold(affine(without_level(part_of(parts.graph, node)))),
                distance = fold(affine(strip(surface)));
    const std::vector<NodeFacts> known = analyse(distance.graph);
    auto field = compile_field(surface, distance, known, painted, source, diagnostics, options);
    if (!field) return std::nullopt;
    pieces.push_back(
        {*std::move(field), is_convex(distance.graph, distance.root), closed_form(distance.graph, distance.root)});
  }
  return pieces;
}

// Reports that the solids of the transparent materials exceed the limit on `what` at the scene's `node`.
void report_media(const Graph& graph, NodeId node, std::string_view what, const Limits& limits,
                  Diagnostics& diagnostics) {
  diagnostics.error(
      "E0312", graph.origin(node).span,
      fmt::format("the solids of the transparent materials have more than {} {} here", limits.media, what), "",
      {"each transparent material has a solid, its bodies without what outranks them in their box: use fewer of "
       "these "
       "materials, or move their bodies apart",
       raise(&Limits::media, 2 * limits.media)});
}

// Compiles the interiors of the transparent materials (compiler/analysis/media.h).
std::optional<std::vector<Medium>> compile_media(const ElaboratedScene& scene, bool painted, const Source& source,
                                                 Diagnostics& diagnostics, const CompileOptions& options) {
  const auto most = static_cast<std::size_t>(options.limits.media);
  MediaMaker maker(scene.scene, scene.surfaces, scene.materials, most);
  if (maker.excess()) {
    report_media(maker.graph(), *maker.excess(), "nodes", options.limits, diagnostics);
    return std::nullopt;
  }
  std::vector<Medium> media;
  std::size_t instructions = 0;
  for (std::size_t i = 0; i < maker.count(); ++i) {
    const MediumScene medium = maker.make(i);
    const Scene inside = optimise(medium.scene, false, options, nullptr);
    if (has_more_values(inside, most - instructions)) {
      report_media(maker.graph(), maker.first_body(i), "instructions", options.limits, diagnostics);
      return std::nullopt;
    }
    auto compiled = compile_field(painted ? optimise(medium.scene, true, options, nullptr) : inside, inside,
                                  analyse(inside.graph), painted, source, diagnostics, options);
    if (!compiled) return std::nullopt;
    instructions = std::min(most, instructions + compiled->distance.instructions());
    media.push_back({std::move(*compiled), medium.material});
  }
  return media;
}

// Compiles the programs of textures. Returns nullopt if a program is too long.
std::optional<std::vector<vm::VerifiedProgram>> assemble_all(const std::vector<Scene>& formulas, const Source& source,
                                                             const Limits& limits, Diagnostics& diagnostics) {
  std::vector<vm::VerifiedProgram> programs;
  for (const Scene& formula : formulas) {
    std::optional<vm::VerifiedProgram> program = assemble(formula, source, true, limits, diagnostics);
    if (!program) return std::nullopt;
    programs.push_back(std::move(*program));
  }
  return programs;
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
  const Scene field = optimise(elaborated->scene, false, options, options.on_pass);
  const std::vector<NodeFacts> known = analyse(field.graph);
  const bool tagged = needs_tags(elaborated->surfaces);
  const Scene painted = tagged || options.pieces ? optimise(elaborated->scene, true, options, nullptr) : Scene{};
  std::optional<CompiledField> whole = compile_field(painted, field, known, tagged, source, diagnostics, options);
  if (!whole) return std::nullopt;
  leave_solids(elaborated->camera, whole->distance);
  std::optional<std::vector<CompiledPiece>> pieces{std::in_place};
  if (options.pieces) pieces = compile_pieces(painted, tagged, source, diagnostics, options);
  if (!pieces) return std::nullopt;
  std::optional<std::vector<Medium>> media = compile_media(*elaborated, tagged, source, diagnostics, options);
  if (!media) return std::nullopt;
  std::optional<std::vector<vm::VerifiedProgram>> formulas =
      assemble_all(elaborated->formulas, source, options.limits, diagnostics);
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
                       std::move(*pieces),
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
  const auto words = [](const CompiledScene& of) { return of.surface.program().words; };
  if (scene && words(*scene) == words(stored)) stored.pieces = std::move(scene->pieces);
}

std::optional<GraphSize> measure(const Scene& scene, const Source& source, const Limits& limits) {
  Diagnostics ignored;
  const std::optional<vm::VerifiedProgram> program = assemble(scene, source, false, limits, ignored);
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
