#include "runtime/mesh/move_to_surface.h"

#include <cmath>
#include <glm/common.hpp>

#include "runtime/mesh/mesh_measures.h"

namespace fathom::runtime {

void move_to_surface(const MeshField& field, const CellLattice& lattice, Contour& contour, int threads) {
  // Distance from the surface above which a vertex moves, in cells, and the number of steps.
  constexpr double kOffSurface = 0.02;
  constexpr int kSteps = 3;
  std::vector<glm::dvec3>& vertices = contour.mesh.vertices;
  PointArrays points;
  std::vector<float> values;
  for (const glm::dvec3& v : vertices) points.push_back(v);
  field.evaluate(points, MeshField::Values::Distance, values, threads);
  struct Walk {
    std::size_t vertex;
    glm::dvec3 place;
    double distance;  // of `place`
  };
  std::vector<Walk> walks;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const double distance = std::abs(static_cast<double>(values[v]));
    if (contour.cells[v] != Contour::kNoCell && distance > kOffSurface * lattice.cell) {
      walks.push_back({v, vertices[v], static_cast<double>(values[v])});
    }
  }
  std::vector<MeshField::SurfacePoint> surfaces;
  for (int step = 0; step < kSteps; ++step) {
    points.clear();
    for (const Walk& walk : walks) points.push_back(walk.place);
    field.find_surfaces(points, surfaces, threads);
    points.clear();
    for (std::size_t i = 0; i < walks.size(); ++i) {
      const compiler::Box box = inset_box(lattice, place_of(contour.cells[walks[i].vertex]));
      points.push_back(glm::clamp(walks[i].place - walks[i].distance * surfaces[i].normal, box.lo, box.hi));
    }
    field.evaluate(points, MeshField::Values::Distance, values, threads);
    for (std::size_t i = 0; i < walks.size(); ++i) {
      const double distance = static_cast<double>(values[i]);
      if (!(std::abs(distance) < std::abs(walks[i].distance))) continue;
      walks[i].place = glm::dvec3(points[i]), walks[i].distance = distance;
    }
  }
  for (const Walk& walk : walks) vertices[walk.vertex] = walk.place;
  turn_right_side_out(lattice, contour);
}

void turn_right_side_out(const CellLattice& lattice, Contour& contour) {
  // With vertices in the middles of cells, a surface consists of faces between corners of different signs.
  TriangleMesh middles = contour.mesh;
  for (std::size_t v = 0; v < middles.vertices.size(); ++v) {
    if (contour.cells[v] == Contour::kNoCell) continue;
    const compiler::Box box = inset_box(lattice, place_of(contour.cells[v]));
    middles.vertices[v] = 0.5 * (box.lo + box.hi);
  }
  DisjointSets connected = connected_vertices(contour.mesh);
  const std::vector<double> volumes = surface_volumes(contour.mesh, connected);
  const std::vector<double> right = surface_volumes(middles, connected);
  for (std::uint32_t v = 0; v < middles.vertices.size(); ++v) {
    const std::uint32_t root = connected.root(v);
    if (!(volumes[root] * right[root] > 0)) contour.mesh.vertices[v] = middles.vertices[v];
  }
}

}  // namespace fathom::runtime
