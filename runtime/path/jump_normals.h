// Normals where a field jumps through zero: its gradient there is that of either side, and not across the jump.
// Tested by: tests/runtime/path/jump_normals_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "runtime/field/field.h"

namespace fathom::runtime {

// A hit and the gradient that the field has there. `wo`: unit length, back along the ray. `offset`: distance at which
// float tells the sides of the surface apart, scene units.
struct JumpQuery {
  glm::dvec3 position, wo, gradient;
  double offset;
};

// Returns the unit normal of the surface at a hit if the field jumps there, towards wo. Returns nothing if the field
// changes as its gradient says. The normal is that of the plane through the hit and two points of the surface next to
// it, found by bisection along the ray's direction.
std::optional<glm::dvec3> jump_normal(const Field& field, const JumpQuery& query, RealScratch& scratch);

}  // namespace fathom::runtime
