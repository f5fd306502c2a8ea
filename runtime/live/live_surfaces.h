// Surfaces as the live page has them: one colour each, and how far the distance to each can be trusted.
// Tested by: tests/runtime/live/live_page_test.cpp
#pragma once

#include <vector>

#include "compiler/graph/node_facts.h"
#include "compiler/scene/compiled_scene.h"
#include "runtime/material/material.h"

namespace fathom::runtime {

// Returns a material for each surface. Textured parameters have the mean of the places that the camera sees, or their
// stand-ins (compiler/scene/material.h) if it sees none.
std::vector<MaterialPoint> mean_materials(const compiler::CompiledScene& scene, const compiler::Camera& camera);

// Returns the exactness of the object that each surface is part of, which the graph of the scene's text has. A file
// without text has only the exactness of the whole.
std::vector<compiler::Exactness> exactness_of_surfaces(const compiler::CompiledScene& scene);

}  // namespace fathom::runtime
