// The insides of what light passes through: one solid for each transparent material.
//
// The scene's field is a union, so it has no surface where a drink meets its glass, or glass the table it stands in.
// Rays within a transparent body are followed against that body's own solid instead: the union of all bodies of its
// material, without those that rank higher where they overlap. Opaque bodies rank highest; among transparent ones the
// higher `priority`, then the material first in the file (after Schmidt and Budge, "Simple Nested Dielectrics in Ray
// Traced Images", Journal of Graphics Tools 7(2), 2002).
// Tested by: tests/compiler/media_test.cpp
#pragma once

#include <span>
#include <vector>

#include "compiler/compiled_scene.h"
#include "compiler/graph.h"

namespace fathom::compiler {

struct MediumScene {
  std::uint32_t material;  // index into SceneTables::materials
  Scene scene;             // negative inside; its Paint nodes are those of the whole
};

// In the materials' order; of those that some body has. A body blended or cut of several materials is inside as the
// first transparent one of them.
std::vector<MediumScene> media_of(const Scene& scene, std::span<const Surface> surfaces,
                                  std::span<const Material> materials);

// Sets Surface::mixed.
void mark_mixed(const Scene& scene, std::span<const Material> materials, std::span<Surface> surfaces);

}  // namespace fathom::compiler
