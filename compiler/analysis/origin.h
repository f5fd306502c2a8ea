// Floating origin: the programs' coordinates begin near what the scene shows, where floats are precise, and not at
// the scene's zero.
//
// A float has 24 bits: at 1e5 neighbouring coordinates are 0.008 apart, and no surface is located more precisely. The
// compiler therefore gives a scene far from zero an origin of its own: it moves each node by -origin, in double,
// before the passes.
//
//     const glm::dvec3 origin = choose_origin(scene, analyse(scene.graph), camera);
//     const Scene local = moved(scene, origin);               // local(p) = scene(p + origin)
//
// Tested by: tests/compiler/analysis/origin_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/node_facts.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Returns the origin in scene units, (0, 0, 0) for most scenes. The first candidate is the centre of the view, the
// box around the camera's position and target. It needs a target within the finite parts of the scene (with a ball on
// an infinite plane, within the ball). The second candidate is the centre of the finite parts' box, which an infinite
// scene extends by the view. A coordinate is 0 where the centre is at most 8 times half the box's diagonal from zero.
// Other coordinates are multiples of the largest power of two within half the diagonal, so that numbers with few
// digits keep few digits. A candidate that would increase float errors is rejected. `known` is the result of
// analyse() (compiler/shapes/bounds.h).
glm::dvec3 choose_origin(const Scene& scene, const std::vector<NodeFacts>& known, const Camera& camera);

// Returns the scene with `origin` at zero. The move passes through nodes that only combine or change distances. It
// ends in the numbers of transforms, planes, triangles and quads, or in a new Transform. Below a new Transform points
// have the scene's coordinates again: a formula written for a far place, or a twist about a far axis, stays as
// imprecise as before, and NodeFacts::cancellation says so.
// A moved Paint gets a surface of its own if a texture uses the node's coordinates: Surface::shift leads back.
Scene moved(const Scene& scene, glm::dvec3 origin, std::vector<Surface>& surfaces);
Scene moved(const Scene& scene, glm::dvec3 origin);

}  // namespace fathom::compiler
