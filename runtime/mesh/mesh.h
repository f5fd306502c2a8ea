// A closed triangle mesh: shared vertices, and for each triangle the surface of the scene that it shows.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace fathom::runtime {

struct Triangle {
  std::array<std::uint32_t, 3> vertices;  // indices, counter-clockwise seen from outside
  std::uint32_t surface;                  // index into CompiledScene::surfaces
};

struct TriangleMesh {
  std::vector<glm::dvec3> vertices;  // in the programs' coordinates, scene units
  std::vector<Triangle> triangles;

  std::array<glm::dvec3, 3> corners(const Triangle& triangle) const {
    return {vertices[triangle.vertices[0]], vertices[triangle.vertices[1]], vertices[triangle.vertices[2]]};
  }
};

// Returns the normal of a triangle, outwards, twice as long as the triangle's area.
inline glm::dvec3 area_normal(const std::array<glm::dvec3, 3>& corners) {
  return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

}  // namespace fathom::runtime
