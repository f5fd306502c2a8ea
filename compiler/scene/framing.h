// Camera that shows a whole box as large as possible.
// Tested by: tests/compiler/scene/framing_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "compiler/geometry/box.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Margin at each side, as a share of the image's width or height. The two sides that limit the box have exactly this
// margin.
inline constexpr double kFrameMargin = 0.06;

// Direction from the target to a camera that the scene does not place: three-quarter view from above.
inline constexpr glm::dvec3 kThreeQuarters{0.55, 0.5, 0.67};

// Moves the camera so that the whole box is within its image. Direction, up, projection and field of view stay. An
// orthographic camera gets the width that it needs. A panorama, which shows everything, moves in front of the box. A
// lens focuses on the box's middle. `aspect` is the image's width over its height. Returns nullopt if the box is
// empty or infinite, or if its size or distance is out of range.
std::optional<Camera> framed(const Camera& camera, const Box& box, double aspect);

// Makes an automatic camera frame the scene's extent in a three-quarter view from above. Any other camera, and any
// camera of a scene without an extent, stays unchanged.
Camera placed(const Camera& camera, const Box& extent, double aspect);

}  // namespace fathom::compiler
