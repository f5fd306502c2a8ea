// In which order named nodes can be made: each after all that it uses.
// Tested by: tests/golden/diagnostics (E0204, W0402), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/frontend/elaborate/check_node.h"
#include "compiler/frontend/elaborate/checked_node.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// A `use` within a node.
struct Use {
  std::uint32_t target;                   // which of the named nodes
  std::optional<std::uint32_t> material;  // the innermost around it; nullopt when none within that node
  Span span;                              // of the record that holds it
};

// Every use in the node, itself included, in file order.
std::vector<Use> uses_of(const CheckedNode& node);

// Reports every cycle that a depth-first walk meets; names that are in none are in the result, each after all that it
// uses. `uses` has a row for each named node.
std::vector<std::uint32_t> order_names(const std::vector<std::vector<Use>>& uses, const Names& names,
                                       Diagnostics& diagnostics);

}  // namespace fathom::compiler
