// Entrances of rays into solids that have a formula for them: balls, boxes, cylinders and half-spaces.
// Not a public header: march.h is. Tested by: tests/runtime/march/closed_form_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

// Uncertain: the ray begins in or next to the solid, or barely touches it, so that rounding may decide.
enum class Meeting : std::uint8_t { Misses, Enters, Uncertain };

struct Entrance {
  Meeting meeting;
  double t;      // of the surface, if the ray enters it
  double slack;  // bound on the error of t
};

// Follows a ray to a solid. `form.shape` is not None, and the direction has unit length.
Entrance find_entrance(const compiler::ClosedForm& form, glm::dvec3 origin, glm::dvec3 direction);

}  // namespace fathom::runtime
