// What fills the space that a ray travels through.
// Tested by: tests/runtime/path/media_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "runtime/field/field.h"
#include "runtime/material/material.h"
#include "runtime/path/media.h"

namespace fathom::runtime {

struct Space {
  std::uint32_t field = 0;  // 0: the scene's; else that of medium number field - 1
  int side = 0;             // of that field, as Ray::side
  float ior = 1;            // relative to vacuum
  glm::vec3 absorption{0};  // per scene unit
};

// Where a place is, in scene units of the programs. Within what is hollow (thin walls, holes) it is taken to be
// filled with nothing.
Space space_at(glm::dvec3 place, const Media& media, const Materials& materials, RealScratch& scratch);

// What the medium is filled with at a place within it.
MaterialPoint filling_at(glm::dvec3 place, std::uint32_t medium, const Media& media, const Materials& materials,
                         RealScratch& scratch);

// Whether all places within `radius` of this one are in the same space. `scene`: its field. May say no where it is
// so.
bool is_even_around(glm::dvec3 place, double radius, const Field& scene, const Media& media, RealScratch& scratch);

}  // namespace fathom::runtime
