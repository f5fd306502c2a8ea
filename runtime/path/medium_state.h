// The medium that a ray travels through.
// Tested by: tests/runtime/path/media_test.cpp
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>

#include "runtime/base/elementary.h"
#include "runtime/field/field.h"
#include "runtime/material/material.h"
#include "runtime/path/media.h"

namespace fathom::runtime {

struct MediumState {
  std::uint32_t field = 0;  // 0: the scene's; else that of medium number field - 1
  int side = 0;             // of that field, as Ray::side
  float ior = 1;            // relative to vacuum
  glm::vec3 absorption{0};  // per scene unit
};

// Returns the medium at a place, in scene units of the programs. Within hollow bodies (thin walls, holes) there is no
// medium.
MediumState medium_at(glm::dvec3 place, const Media& media, const Materials& materials, RealScratch& scratch);

// Returns the material that fills the medium, at a place within it.
MaterialPoint interior_at(glm::dvec3 place, std::uint32_t medium, const Media& media, const Materials& materials,
                          RealScratch& scratch);

// True if all places within `radius` of this one are in the same medium. `scene`: its field. May be false although
// they are.
bool is_uniform_around(glm::dvec3 place, double radius, const Field& scene, const Media& media, RealScratch& scratch);

// Returns the share of light that a medium lets through over a distance: Beer-Lambert law.
inline glm::vec3 transmittance(const MediumState& medium, double distance) {
  // Longer distances count as this long, because 0 absorption times infinity is NaN.
  constexpr double kMaxDistance = 1e30;
  if (medium.absorption == glm::vec3(0)) [[likely]]
    return glm::vec3(1);
  return exp(-medium.absorption * static_cast<float>(std::min(distance, kMaxDistance)));
}

}  // namespace fathom::runtime
