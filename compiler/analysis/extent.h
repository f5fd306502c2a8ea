// How large a scene is: the box of its solids that end.
// Tested by: tests/compiler/analysis/extent_test.cpp
#pragma once

#include <vector>

#include "compiler/geometry/box.h"
#include "compiler/graph/graph.h"
#include "compiler/graph/knowledge.h"

namespace fathom::compiler {

// The box round all parts of the scene that end; empty when there are none. Planes, endless copies and other parts
// without an end are left out. What is cut from one of them counts: a pit is what there is to see of a ground.
// `known` is of analyse() (compiler/shapes/bounds.h).
Box extent(const Scene& scene, const std::vector<Knowledge>& known);

}  // namespace fathom::compiler
