// Solids and outlines, each in its place: outlines below extrude and revolve and nowhere else, never mixed, placed
// within their plane. After check_node.h, which leaves names to be looked up: here they are known.
// Tested by: tests/golden/diagnostics (E0306, E0307), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/frontend/elaborate/checked_node.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// `order` is that of `named`, as order_names() gives it. Transforms of outlines lose what they say of z, along which
// an outline has no end: their distances then keep as much as the plane's scales allow.
void check_sorts(std::vector<CheckedNode>& named, const std::vector<std::uint32_t>& order,
                 std::vector<CheckedNode>& objects, Diagnostics& diagnostics);

}  // namespace fathom::compiler
