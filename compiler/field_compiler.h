// The compiler's middle and end: from the graph of a solid to its programs, its pieces and the facts about them.
// Tested by: tests/compiler/passes/passes_test.cpp, tests/compiler/analysis/media_test.cpp
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontend/elaborate/elaborate.h"
#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"
#include "compiler/source/source.h"

namespace fathom::compiler {

// Names of the steps around the passes.
inline constexpr std::string_view kGraph = "graph";    // the graph as read
inline constexpr std::string_view kOrigin = "origin";  // the first step (compiler/analysis/origin.h)
inline constexpr std::string_view kFuse = "fuse";      // the last step, over programs

// Runs the passes, up to the one of the name `stop_after`, all but that which takes Paint from the graph if
// `keep_paint`. Calls `on_pass` after each.
Scene optimise(Scene scene, bool keep_paint, const std::optional<std::string>& stop_after,
               const std::function<void(std::string_view, const Scene&)>& on_pass = nullptr);

// Reports an error to `diagnostics` if a function returns nullopt.
struct FieldCompiler {
  const Source& source;
  const Limits& limits;
  const std::optional<std::string>& stop_after;  // as optimise() takes it
  bool split;                                    // into pieces
  bool tagged;                                   // surface programs have tags
  Diagnostics& diagnostics;

  // True if compile() reads the painted scene.
  bool needs_paint() const { return tagged || split; }
  // Compiles a scene after the passes: `distance` is without Paint, `painted` with it.
  std::optional<SplitField> compile(const Scene& distance, const Scene& painted) const;
  // Compiles the interiors of the transparent materials (compiler/analysis/media.h).
  std::optional<std::vector<Medium>> compile_media(const ElaboratedScene& scene) const;
  // Compiles the programs of textures.
  std::optional<std::vector<vm::VerifiedProgram>> compile_formulas(const std::vector<Scene>& formulas) const;
  std::optional<vm::VerifiedProgram> assemble(const Scene& scene) const;

 private:
  std::optional<CompiledField> compile_whole(const Scene& distance, const Scene& painted) const;
  std::optional<std::vector<CompiledPiece>> compile_pieces(const Scene& painted) const;
  void report_media(const Graph& graph, NodeId node, std::string_view what) const;
};

}  // namespace fathom::compiler
