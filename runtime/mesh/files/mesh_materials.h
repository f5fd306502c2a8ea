// Materials as mesh formats know them: one colour and a few numbers, without textures.
// Tested by: tests/runtime/mesh/files/mesh_file_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/mesh/mesh.h"

namespace fathom::runtime {

struct MeshMaterial {
  std::string name;
  glm::dvec3 color{0.8};  // albedo, or tint of a clear surface, linear sRGB
  glm::dvec3 emission{0};
  double metalness = 0, roughness = 1, opacity = 1;
  double transmission = 0, ior = 1.5;
  bool has_interior = false;  // light that gets through the surface is in a body
  glm::dvec3 absorption{0};   // of that body, per scene unit
};

// A linear colour as an sRGB signal of 8 bits.
std::array<std::uint8_t, 3> color_bytes(glm::dvec3 color);
// The colour in formats without emission: all the light that leaves a lit surface.
std::array<std::uint8_t, 3> shown_color_bytes(const MeshMaterial& material);

// Returns the materials of a scene, and appends to `of_surface` the index of each surface's material. A textured
// material is the mean over triangles of the mesh.
std::vector<MeshMaterial> mesh_materials(const compiler::CompiledScene& scene, const TriangleMesh& mesh,
                                         std::vector<std::uint32_t>& of_surface);

}  // namespace fathom::runtime
