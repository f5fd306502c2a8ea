// The compiler's one function: scene text, in any format of read_scene.h, to CompiledScene. compile.cpp reads as the
// list of passes. Tested by: tests/compiler/passes/passes_test.cpp
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
  // Stop after the step of this name; "graph" stands for "before the first": the graph as it was read, its origin 0.
  std::optional<std::string> stop_after;
  // Called with the distance graph as it was read (as "graph") and after each step.
  std::function<void(std::string_view pass, const Scene& scene)> on_pass;
  Limits limits;
  // Values for the scene's parameters in place of its own.
  Definitions definitions;
  // Reads the files that the scene imports; without it only those that its source has are found.
  ImportReader imports;
  // Warn of what is sound but surely not meant, or dear (compiler/analysis/lints.h).
  bool lint = false;
  // Warn of what will be seen in the picture, as that no light reaches the camera; `lint` does so, too.
  bool lint_picture = false;
  // The file of the background's picture when the caller has the picture: it is not looked for.
  std::string file_at_hand = "";
  // A model from elsewhere gets a ground, a lamp and a camera that has it in the picture (compiler/frontend/stage.h).
  bool stage = false;
  // Called with the source and the files that it imports, in which the spans of all diagnostics are; also when it is
  // not understood.
  std::function<void(const Source& source)> on_source;
  // The programs' zero in the scene, in place of one chosen for the scene (compiler/analysis/origin.h).
  std::optional<glm::dvec3> origin;
  // Called with what the front end read, its stage with it.
  std::function<void(const ReadScene& scene)> on_syntax;
};

// nullopt exactly when `diagnostics` has errors afterwards.
std::optional<CompiledScene> compile(Source source, Diagnostics& diagnostics, const CompileOptions& options = {});

// What a graph comes to as it stands, before instructions are fused.
struct GraphSize {
  std::size_t nodes;         // that the root reaches
  std::size_t instructions;  // of its program
  std::size_t cost;          // multiply-adds a point
};

// nullopt when the graph's program goes beyond a limit of the machine.
std::optional<GraphSize> measure(const Scene& scene, const Source& source, const Limits& limits = {});

// Names of the steps, in order: compiler/analysis/origin.h, those over the graph (compiler/passes/passes.h), compiler/lower/fuse.h.
std::vector<std::string_view> pass_names();

}  // namespace fathom::compiler
