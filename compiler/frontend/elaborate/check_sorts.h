// Checker for the sorts of nodes, solid and outline. Outlines may occur only below extrude and revolve, must not be
// mixed with solids, and must stay within their plane. Runs after check_node.h, when all names are resolved.
// Tested by: tests/golden/diagnostics (E0306, E0307), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/frontend/elaborate/checked_node.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// `order` is the order of `named` that order_names() returns. Removes the z scale from transforms of outlines,
// because an outline is unbounded along z. The distance factor then depends on the x and y scales only and is as
// large as they allow.
void check_sorts(std::vector<CheckedNode>& named, const std::vector<std::uint32_t>& order,
                 std::vector<CheckedNode>& objects, Diagnostics& diagnostics);

}  // namespace fathom::compiler
