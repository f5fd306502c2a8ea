// A camera that has the whole of a box in its picture, as large as it goes.
// Tested by: tests/compiler/scene/framing_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "compiler/geometry/box.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Of the picture's width and height, at each side. On the two sides that hold the box in, no more.
inline constexpr double kFrameMargin = 0.06;

// From what is looked at to a camera that no one placed: from three quarters, above.
inline constexpr glm::dvec3 kThreeQuarters{0.55, 0.5, 0.67};

// The camera, moved so that all of the box is within its picture; direction, up, projection and field of view stay.
// An orthographic camera's width becomes what is needed. A panorama, which shows everything, is put in front of the
// box. A lens is focused on the box's middle. `aspect` is the picture's width over its height. nullopt when the box
// is empty, does not end, or is of a size or at a distance for which there are no numbers.
std::optional<Camera> framed(const Camera& camera, const Box& box, double aspect);

// A camera that is automatic, framing the scene's extent from three quarters above; any other, and one of a scene
// that has no extent, as it is.
Camera placed(const Camera& camera, const Box& extent, double aspect);

}  // namespace fathom::compiler
