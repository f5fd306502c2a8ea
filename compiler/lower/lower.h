// Lowers the DAG to stack code: the order of operands, locals for shared nodes, and points for nodes that move, fold
// or bend space.
// Tested by: tests/compiler/passes/passes_test.cpp, tests/golden (dumps)
#pragma once

#include <optional>

#include "compiler/graph/graph.h"
#include "vm/program/program.h"

namespace fathom::compiler {

// Returns nullopt if the code would exceed `max_instructions`: a node used under different transforms is evaluated
// anew for each of them, so a small file can stand for a huge program.
std::optional<vm::Program> lower(const Graph& graph, NodeId root, const Source& source, std::size_t max_instructions);

inline std::optional<vm::Program> lower(const Scene& scene, const Source& source, std::size_t max_instructions) {
  return lower(scene.graph, scene.root, source, max_instructions);
}

// True if the entry's line is one of a file that `source` imports: the entry's symbol then ends with that file.
bool is_in_import(const vm::DebugEntry& entry, const Source& source);

// True if the scene's program computes more than `most` values, each of which takes at least one instruction. Takes a
// tenth of the time and the memory of lower().
bool has_more_values(const Scene& scene, std::size_t most);

}  // namespace fathom::compiler
