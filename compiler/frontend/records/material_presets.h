// Substances by name, for principled materials: metals by their measured refractive index, clear ones by theirs.
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
  std::vector<std::pair<std::string_view, glm::dvec3>> values;  // of properties; of one number, three times that
};

std::span<const MaterialPreset> material_presets();

// Reflectance for unpolarised light of a conductor with the refractive index n + ik. `cosine` of the angle of
// incidence, in [0,1]. Source: Born and Wolf, "Principles of Optics", 7th ed. 1999, section 14.2.
double conductor_reflectance(double cosine, double n, double k);

}  // namespace fathom::compiler
