#include "runtime/mesh/files/mesh_materials.h"

#include "compiler/scene/srgb.h"
#include "runtime/material/material.h"

namespace fathom::runtime {
namespace {

MeshMaterial to_mesh_material(const std::string& name, const MaterialPoint& m) {
  MeshMaterial material;
  const MaterialPoint principled = to_principled(m);
  material.name = name;
  material.transmission = static_cast<double>(principled.transmission);
  material.color =
      glm::mix(glm::dvec3(m.base_color), glm::dvec3(principled.transmission_color), material.transmission);
  material.emission = glm::dvec3(m.emitted_radiance());
  material.metalness = static_cast<double>(principled.metalness);
  material.roughness = m.type == MaterialType::Diffuse || m.type == MaterialType::Emissive
                           ? 1
                           : static_cast<double>(principled.roughness);
  material.opacity = static_cast<double>(m.opacity);
  material.ior = static_cast<double>(m.ior);
  material.has_interior = m.has_interior();
  material.absorption = glm::dvec3(m.absorption);
  return material;
}

// Returns the mean of a textured material at triangles that have it.
MaterialPoint mean_of(const compiler::CompiledScene& scene, const Materials& materials, std::uint32_t index,
                      const TriangleMesh& mesh, const std::vector<std::uint32_t>& of_surface) {
  constexpr std::size_t kMostPoints = 256;
  std::vector<glm::dvec3> points;
  for (const Triangle& triangle : mesh.triangles) {
    if (of_surface[triangle.surface] != index) continue;
    const auto corners = mesh.corners(triangle);
    points.push_back((corners[0] + corners[1] + corners[2]) / 3.0);
  }
  vm::Workspace workspace;
  MaterialPoint mean = materials.untextured(index);
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kMostPoints) {
    glm::dvec3 place = points[i];
    if (materials.uses_object_space(index)) {
      const vm::SurfacePlace found = vm::evaluate_place(scene.surface, place, workspace);
      place =
          found.place + (found.surface < scene.surfaces.size() ? scene.surfaces[found.surface].shift : glm::dvec3(0));
    }
    mean = mix(mean, materials.at(index, points[i], place, workspace), 1 / static_cast<float>(++count));
  }
  return mean;
}

}  // namespace

std::array<std::uint8_t, 3> color_bytes(glm::dvec3 color) {
  std::array<std::uint8_t, 3> bytes{};
  for (int i = 0; i < 3; ++i) {
    bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(compiler::srgb_encode(color[i]) * 255 + 0.5);
  }
  return bytes;
}

std::array<std::uint8_t, 3> shown_color_bytes(const MeshMaterial& material) {
  return color_bytes(glm::min(material.color + material.emission, 1.0));
}

std::vector<MeshMaterial> mesh_materials(const compiler::CompiledScene& scene, const TriangleMesh& mesh,
                                         std::vector<std::uint32_t>& of_surface) {
  const Materials known(scene);
  for (const compiler::Surface& surface : scene.surfaces) of_surface.push_back(surface.material);
  if (of_surface.empty()) of_surface.push_back(0);
  std::vector<MeshMaterial> materials;
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    const MaterialPoint point =
        known.is_textured(i) ? mean_of(scene, known, i, mesh, of_surface) : known.untextured(i);
    materials.push_back(to_mesh_material(scene.materials[i].name, point));
  }
  if (materials.empty()) materials.push_back({});
  return materials;
}

}  // namespace fathom::runtime
