// DAG to stack code: the order of operands, locals for shared nodes, points for what moves, folds or bends space.
// Tested by: tests/compiler/passes/passes_test.cpp, tests/golden (dumps)
#pragma once

#include <optional>

#include "compiler/graph/graph.h"
#include "vm/program/program.h"

namespace fathom::compiler {

// nullopt when the code would exceed `max_instructions`: a node used under different transforms is evaluated anew for
// each, so a small file can stand for a huge program.
std::optional<vm::Program> lower(const Graph& graph, NodeId root, const Source& source, std::size_t max_instructions);

inline std::optional<vm::Program> lower(const Scene& scene, const Source& source, std::size_t max_instructions) {
  return lower(scene.graph, scene.root, source, max_instructions);
}

// Whether the scene's program computes more than `most` values, each of which takes an instruction or more: told in a
// tenth of the time and the memory that lower() takes.
bool has_more_values(const Scene& scene, std::size_t most);

}  // namespace fathom::compiler
