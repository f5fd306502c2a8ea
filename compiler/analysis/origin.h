// Precision where it is needed: the programs' coordinates begin near what the scene shows, not at the scene's zero.
//
// A float has 24 bits: at 1e5 neighbouring coordinates are 0.008 apart, and no surface is known better. So a scene
// far from zero is compiled around an origin of its own: each node is moved by -origin, in double, before the passes.
//
//     const glm::dvec3 origin = choose_origin(scene, analyse(scene.graph), camera);
//     const Scene local = moved(scene, origin);               // local(p) = scene(p + origin)
//
// Tested by: tests/compiler/analysis/origin_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/knowledge.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Scene units. The middle of what the camera looks at, the box of the way to its target, when the target lies within
// the parts of the scene that end (beside an endless plane, a ball); else the middle of those parts, to which in a
// scene without an end in some direction the way to the target is added. 0 along axes on which the middle is no
// farther from zero than 8 times half the box's diagonal, as in most scenes it is not. A multiple of the largest
// power of two within the latter, so that numbers of few digits stay so. No origin is chosen that would make float
// errors larger. `known` is of analyse() (compiler/shapes/bounds.h).
glm::dvec3 choose_origin(const Scene& scene, const std::vector<Knowledge>& known, const Camera& camera);

// The scene with `origin` at zero. A move goes through what only combines or changes distances, and ends in the
// numbers of transforms, planes, triangles and quads, or in a new transform. Below that transform points have the
// scene's coordinates once more: a formula written for a far place, a twist about a far axis stay as coarse as they
// were, which Knowledge::magnitude says.
// A Paint that is moved gives a surface of its own where textures are in the node's coordinates: Surface::shift leads
// back to these.
Scene moved(const Scene& scene, glm::dvec3 origin, std::vector<Surface>& surfaces);
Scene moved(const Scene& scene, glm::dvec3 origin);

}  // namespace fathom::compiler
