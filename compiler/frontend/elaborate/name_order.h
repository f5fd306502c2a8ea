// Topological order of named nodes: each name comes after all names that it uses.
// Tested by: tests/golden/diagnostics (E0204, W0402), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/frontend/elaborate/check_node.h"
#include "compiler/frontend/elaborate/checked_node.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Occurrence of `use` within a node.
struct Use {
  std::uint32_t target;                   // number of the named node
  std::optional<std::uint32_t> material;  // innermost material around the use; nullopt if the node gives none
  Span span;                              // the record that contains the use
};

// Returns every use in a node, including the node itself, in file order.
std::vector<Use> uses_of(const CheckedNode& node);

// Reports every cycle that a depth-first walk meets. The result contains every name that is not part of a cycle, each
// after all names that it uses. `uses` has one entry per named node.
std::vector<std::uint32_t> order_names(const std::vector<std::vector<Use>>& uses, const Names& names,
                                       Diagnostics& diagnostics);

}  // namespace fathom::compiler
