// Presets for principled materials: metals by their measured complex refractive index, dielectrics by their index.
// Tested by: tests/compiler/frontend/elaborate/materials_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace fathom::compiler {

struct MaterialPreset {
  std::string_view name;
  std::vector<std::pair<std::string_view, glm::dvec3>> values;  // of properties; a scalar is repeated three times
};

std::span<const MaterialPreset> material_presets();

// Returns the unpolarised Fresnel reflectance of a conductor with refractive index n + ik. `cosine` is that of the
// angle of incidence, in [0,1]. Source: Born and Wolf, "Principles of Optics", 7th ed. 1999, section 14.2.
double conductor_reflectance(double cosine, double n, double k);

}  // namespace fathom::compiler
