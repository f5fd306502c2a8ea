// Materials as shading wants them: single precision, ready to use.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "compiler/compiled_scene.h"

namespace fathom::runtime {

// The compiler's material in float; colours are linear sRGB.
struct Material {
  using Type = compiler::Material::Type;
  Type type;
  glm::vec3 color;
  glm::vec3 emission;    // radiance; black unless emissive
  float ior;             // inside relative to outside
  glm::vec3 absorption;  // per scene unit
};

inline Material to_material(const compiler::Material& m) {
  const bool emissive = m.type == compiler::Material::Type::Emissive;
  return {m.type, m.color, emissive ? glm::vec3(m.emission) : glm::vec3(0), static_cast<float>(m.ior), m.absorption};
}

inline std::vector<Material> to_materials(const compiler::CompiledScene& scene) {
  std::vector<Material> materials;
  for (const compiler::Material& m : scene.materials) materials.push_back(to_material(m));
  return materials;
}

// What the albedo picture shows: the colour, and for lamps the light's, clamped to white.
inline glm::vec3 albedo_of(const Material& m) {
  if (m.type != Material::Type::Emissive) return m.color;
  const glm::vec3 sum = m.color + m.emission;
  return {sum.x < 1 ? sum.x : 1, sum.y < 1 ? sum.y : 1, sum.z < 1 ? sum.z : 1};
}

}  // namespace fathom::runtime
