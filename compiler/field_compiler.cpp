#include "compiler/field_compiler.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "compiler/analysis/extent.h"
#include "compiler/analysis/formula_cells.h"
#include "compiler/analysis/media.h"
#include "compiler/geometry/fits_float.h"
#include "compiler/graph/rewrite.h"
#include "compiler/lower/fuse.h"
#include "compiler/lower/lower.h"
#include "compiler/passes/closed_forms.h"
#include "compiler/passes/passes.h"
#include "compiler/passes/split.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {
namespace {

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

}  // namespace

Scene optimise(Scene scene, bool keep_paint, const std::optional<std::string>& stop_after,
               const std::function<void(std::string_view, const Scene&)>& on_pass) {
  if (stop_after == kGraph) return scene;
  if (on_pass) on_pass(kOrigin, scene);
  if (stop_after == kOrigin) return scene;
  for (const Pass& pass : passes()) {
    if (!(keep_paint && pass.run == strip)) scene = pass.run(scene);
    if (on_pass) on_pass(pass.name, scene);
    if (stop_after == pass.name) break;
  }
  return scene;
}

std::optional<vm::VerifiedProgram> FieldCompiler::assemble(const Scene& scene) const {
  const bool fused = stop_after.value_or(std::string(kFuse)) == kFuse;
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

std::optional<CompiledField> FieldCompiler::compile_whole(const Scene& distance, const Scene& painted) const {
  std::optional<vm::VerifiedProgram> program = assemble(distance);
  if (!program) return std::nullopt;
  std::optional<vm::VerifiedProgram> surface = program;
  if (tagged) surface = assemble(painted);
  if (!surface) return std::nullopt;
  const std::vector<NodeFacts> known = analyse(distance.graph);
  const NodeFacts& all = known[distance.root];
  const FormulaCells cells =
      formula_cells(distance.graph, distance.root, known).value_or(FormulaCells{{}, 0, all.cancellation});
  return CompiledField{
      std::move(*program), std::move(*surface), all.box,       contents(distance.graph, distance.root, known),
      all.lipschitz,       cells.cancellation,  all.certified, cells.box,
      cells.rest_lipschitz};
}

// Returns no pieces of a scene that is one piece, or too many.
std::optional<std::vector<CompiledPiece>> FieldCompiler::compile_pieces(const Scene& painted) const {
  std::vector<CompiledPiece> pieces;
  constexpr std::size_t kMostPieces = 1 << 15;  // each of some kilobytes
  const Pieces parts = compiler::split(painted);
  if (parts.nodes.size() < 2 || parts.nodes.size() > kMostPieces) return pieces;
  for (const NodeId node : parts.nodes) {
    const Scene surface = fold(affine(without_level(part_of(parts.graph, node)))),
                distance = fold(affine(strip(surface)));
    auto field = compile_whole(distance, surface);
    if (!field) return std::nullopt;
    pieces.push_back(
        {*std::move(field), is_convex(distance.graph, distance.root), closed_forms(distance.graph, distance.root)});
  }
  return pieces;
}

std::optional<SplitField> FieldCompiler::compile(const Scene& distance, const Scene& painted) const {
  std::optional<CompiledField> whole = compile_whole(distance, painted);
  if (!whole) return std::nullopt;
  std::optional<std::vector<CompiledPiece>> pieces{std::in_place};
  if (split) pieces = compile_pieces(painted);
  if (!pieces) return std::nullopt;
  return SplitField{*std::move(whole), *std::move(pieces)};
}

// Reports that the solids of the transparent materials exceed the limit on `what` at the scene's `node`.
void FieldCompiler::report_media(const Graph& graph, NodeId node, std::string_view what) const {
  diagnostics.error(
      "E0312", graph.origin(node).span,
      fmt::format("the solids of the transparent materials have more than {} {} here", limits.media, what), "",
      {"each transparent material has a solid, its bodies without what outranks and may overlap them: use fewer of "
       "these materials, or move their bodies apart",
       raise(&Limits::media, 2 * limits.media)});
}

std::optional<std::vector<Medium>> FieldCompiler::compile_media(const ElaboratedScene& scene) const {
  const auto most = static_cast<std::size_t>(limits.media);
  MediaMaker maker(scene.scene, scene.surfaces, scene.materials, most);
  if (maker.excess()) {
    report_media(maker.graph(), *maker.excess(), "nodes");
    return std::nullopt;
  }
  std::vector<Medium> media;
  std::size_t instructions = 0;
  for (std::size_t i = 0; i < maker.count(); ++i) {
    const MediumScene medium = maker.make(i);
    const Scene inside = optimise(medium.scene, false, stop_after);
    if (has_more_values(inside, most - instructions)) {
      report_media(maker.graph(), maker.first_body(i), "instructions");
      return std::nullopt;
    }
    std::optional<SplitField> compiled =
        compile(inside, needs_paint() ? optimise(medium.scene, true, stop_after) : inside);
    if (!compiled) return std::nullopt;
    instructions = std::min(most, instructions + compiled->distance.instructions());
    media.push_back({std::move(*compiled), medium.material});
  }
  return media;
}

std::optional<std::vector<vm::VerifiedProgram>> FieldCompiler::compile_formulas(
    const std::vector<Scene>& formulas) const {
  std::vector<vm::VerifiedProgram> programs;
  for (const Scene& formula : formulas) {
    std::optional<vm::VerifiedProgram> program = assemble(formula);
    if (!program) return std::nullopt;
    programs.push_back(std::move(*program));
  }
  return programs;
}

}  // namespace fathom::compiler
