// Formulas that have bounds of their slope in cells of their box: a formula that jumps or has an infinite slope
// somewhere, so that the slope has no bound all over the box, and a formula that is much steeper elsewhere than near
// its surface, so that a bound all over the box makes for short steps. The renderer bounds the slope cell by cell
// (runtime/field/slope_cells.h), and decides by interval arithmetic where a cell has no bound.
// Tested by: tests/compiler/analysis/formula_cells_test.cpp
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/geometry/box.h"
#include "compiler/graph/graph.h"
#include "compiler/graph/node_facts.h"

namespace fathom::compiler {

struct FormulaCells {
  Box box;                // around the parts of the field that contain such formulas; finite
  double rest_lipschitz;  // Lipschitz constant of the rest of the field; 0 if there is no rest
  double cancellation;    // NodeFacts::cancellation of the field, without that of the formulas
};

inline constexpr std::ptrdiff_t kMaxCellNodes = 1000;

// Returns the cells of a field with such formulas. Returns nothing if there are none, if a part without a proof is
// anything except such a formula, if the field is not a union of bounded parts with formulas and of the rest, or if
// it has more than kMaxCellNodes nodes: every interval along a ray evaluates all of them. `known` is the result of
// analyse() (compiler/shapes/bounds.h).
std::optional<FormulaCells> formula_cells(const Graph& graph, NodeId root, const std::vector<NodeFacts>& known);

}  // namespace fathom::compiler
