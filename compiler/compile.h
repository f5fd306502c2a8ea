// The compiler's entry point, which turns scene text in any format of read_scene.h into a CompiledScene. compile.cpp
// reads as the list of passes. Tested by: tests/compiler/passes/passes_test.cpp
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontend/read_scene.h"
#include "compiler/frontend/records/parameters.h"
#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

struct CompileOptions {
  // Name of the step to stop after. "graph" stops before the first step: the graph is as read, and its origin is 0.
  std::optional<std::string> stop_after;
  // Called with the distance graph as read (under the name "graph") and after each step.
  std::function<void(std::string_view pass, const Scene& scene)> on_pass;
  Limits limits;
  // Values that replace the defaults of the scene's parameters.
  Definitions definitions;
  // Reads the files that the scene imports. Without a reader only the files that the source already contains are
  // found.
  ImportReader imports;
  // Warn about scenes that are valid but surely not meant, or expensive (compiler/analysis/lints.h).
  bool lint = false;
  // Warn about what the image will show, e.g. that no light reaches the camera. Implied by `lint`.
  bool lint_picture = false;
  // File of the background image if the caller has the image already: the compiler does not look for that file.
  std::string file_at_hand = "";
  // Give a model in a foreign format a ground, a light and a camera that frames the model
  // (compiler/frontend/stage.h).
  bool stage = false;
  // Compile the scene's pieces, too (CompiledScene::pieces), and not only the whole.
  bool pieces = false;
  // Called with the source and its imports, which contain the spans of all diagnostics, even if reading the source
  // fails.
  std::function<void(const Source& source)> on_source;
  // Place in the scene of the programs' zero. By default the compiler chooses a place (compiler/analysis/origin.h).
  std::optional<glm::dvec3> origin;
  // Called with the scene that the front end read, including the stage.
  std::function<void(const ReadScene& scene)> on_syntax;
};

// Compiles a scene. Returns nullopt exactly when `diagnostics` has errors afterwards.
std::optional<CompiledScene> compile(Source source, Diagnostics& diagnostics, const CompileOptions& options = {});

// Gives a scene that was read from a compiled file the pieces that its text has, with the definitions of the file. A
// scene whose programs are not those of its text stays whole.
void restore_pieces(CompiledScene& stored, const Definitions& definitions, const Limits& limits);

// Size of a graph before the compiler fuses its instructions.
struct GraphSize {
  std::size_t nodes;         // reachable from the root
  std::size_t instructions;  // of the graph's program
  std::size_t cost;          // multiply-adds per point
};

// Returns nullopt if the graph's program exceeds a limit of the machine.
std::optional<GraphSize> measure(const Scene& scene, const Source& source, const Limits& limits = {});

// Returns the names of the steps in order: the origin (compiler/analysis/origin.h), the passes over the graph
// (compiler/passes/passes.h), and fusion (compiler/lower/fuse.h).
std::vector<std::string_view> pass_names();

}  // namespace fathom::compiler
