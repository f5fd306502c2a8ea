#include "runtime/mesh/files/mesh_materials.h"

#include "compiler/scene/srgb.h"
#include "runtime/material/material.h"

namespace fathom::runtime {
namespace {

MeshMaterial to_mesh_material(const std::string& name, const MaterialPoint& m) {
  MeshMaterial material;
  material.name = name;
  material.color = m.type == MaterialType::Transparent ? glm::dvec3(m.transmission_color) : glm::dvec3(albedo_of(m));
  material.emission = glm::dvec3(m.emitted_radiance());
  const MaterialPoint principled = to_principled(m);
  material.metalness = static_cast<double>(principled.metalness);
  material.roughness = m.type == MaterialType::Diffuse ? 1 : static_cast<double>(principled.roughness);
  material.opacity = static_cast<double>(m.opacity);
  return material;
}

// Returns the mean of a textured material's colours at triangles that have it.
glm::dvec3 mean_color(const compiler::CompiledScene& scene, const Materials& materials, std::uint32_t index,
                      const TriangleMesh& mesh, const std::vector<std::uint32_t>& of_surface) {
  constexpr std::size_t kMostPoints = 256;
  std::vector<glm::dvec3> points;
  for (const Triangle& triangle : mesh.triangles) {
    if (of_surface[triangle.surface] != index) continue;
    const auto corners = mesh.corners(triangle);
    points.push_back((corners[0] + corners[1] + corners[2]) / 3.0);
  }
  vm::Workspace workspace;
  glm::dvec3 sum(0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kMostPoints, ++count) {
    glm::dvec3 place = points[i];
    if (materials.uses_object_space(index)) {
      const vm::SurfacePlace found = vm::evaluate_place(scene.surface, place, workspace);
      place =
          found.place + (found.surface < scene.surfaces.size() ? scene.surfaces[found.surface].shift : glm::dvec3(0));
    }
    sum += glm::dvec3(albedo_of(materials.at(index, points[i], place, workspace)));
  }
  return count > 0 ? sum / static_cast<double>(count) : glm::dvec3(albedo_of(materials.untextured(index)));
}

}  // namespace

std::array<std::uint8_t, 3> color_bytes(const MeshMaterial& material) {
  std::array<std::uint8_t, 3> bytes{};
  for (int i = 0; i < 3; ++i) {
    bytes[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(compiler::srgb_encode(material.color[i]) * 255 + 0.5);
  }
  return bytes;
}

std::vector<MeshMaterial> mesh_materials(const compiler::CompiledScene& scene, const TriangleMesh& mesh,
                                         std::vector<std::uint32_t>& of_surface) {
  const Materials known(scene);
  std::vector<MeshMaterial> materials;
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    materials.push_back(to_mesh_material(scene.materials[i].name, known.untextured(i)));
  }
  if (materials.empty()) materials.push_back({});
  for (const compiler::Surface& surface : scene.surfaces) of_surface.push_back(surface.material);
  if (of_surface.empty()) of_surface.push_back(0);
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    if (known.is_textured(i)) materials[i].color = mean_color(scene, known, i, mesh, of_surface);
  }
  return materials;
}

}  // namespace fathom::runtime
