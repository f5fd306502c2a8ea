// Extent of a scene: the bounding box of its finite solids, and a camera outside of the others.
// Tested by: tests/compiler/analysis/extent_test.cpp
#pragma once

#include <vector>

#include "compiler/geometry/box.h"
#include "compiler/graph/graph.h"
#include "compiler/graph/node_facts.h"
#include "compiler/scene/compiled_scene.h"
#include "vm/interpret/evaluate.h"

namespace fathom::compiler {

// Returns the bounding box of all finite parts of the scene; empty when there are none. Planes, endless copies and
// other infinite parts are left out. A solid cut from an infinite part counts: a pit is the visible part of a ground.
// `known` is the result of analyse() (compiler/shapes/bounds.h).
Box extent(const Scene& scene, const std::vector<NodeFacts>& known);

// Moves an automatic camera that is within a solid out of it, without turning it: parts without an end can be where the
// camera would stand. `distance` is the scene's program.
void leave_solids(Camera& camera, const vm::Code& distance);

}  // namespace fathom::compiler
