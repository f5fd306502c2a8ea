// The node table: one row per kind of node; the enum Kind (compiler/graph/graph.h) has the number of each row. The
// front end, the error messages, the schema, the graph printer, the bounds, the lowering and the tests read the
// table. Similar rows share a file: solids.cpp, polyhedra.cpp, fractals.cpp, composed.cpp, outlines.cpp,
// round_outlines.cpp, alterations.cpp, domain.cpp, repetition.cpp, combinators.cpp, functions.cpp.
//
// Conventions, the same for every node:
//   - primitives are centred at the origin, symmetric ones about the y axis (right-handed, y up);
//   - outlines lie in the xy plane: extrude draws them along z, revolve turns them about y;
//   - every length is a radius or a half extent, in scene units, and includes any rounding;
//   - angles are in degrees;
//   - `k` is the width of a smooth blend; the surface moves by at most k/4;
//   - a `thickness` is measured to either side: a wall is 2 * thickness thick.
// Tested by: tests/compiler/shapes/shapes_test.cpp
#pragma once

#include <string_view>
#include <vector>

#include "compiler/shapes/node_spec.h"

namespace fathom::compiler {

const std::vector<NodeSpec>& node_table();
const NodeSpec& spec(Kind kind);
// Finds a node of scene files; nullptr if no node has the name.
const NodeSpec* find_node(std::string_view name);
// Finds a function of formulas; nullptr if no function has the name.
const NodeSpec* find_function(std::string_view name);

}  // namespace fathom::compiler
