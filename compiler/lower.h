// DAG to stack code: the order of operands, locals for shared nodes, points for transforms.
// Tested by: tests/compiler/passes_test.cpp, tests/golden (dumps)
#pragma once

#include <optional>

#include "compiler/graph.h"
#include "vm/program.h"

namespace fathom::compiler {

// nullopt when the code would exceed `max_instructions`: a node used under different transforms is evaluated anew for
// each, so a small file can stand for a huge program.
std::optional<vm::Program> lower(const Scene& scene, const Source& source, std::size_t max_instructions);

}  // namespace fathom::compiler
