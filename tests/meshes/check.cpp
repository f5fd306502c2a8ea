// Checks an STL file with CGAL: tests/suites/meshes compiles and calls this program.
//
// Prints: triangles, 1 if CGAL takes the triangles as a manifold, border edges, 1 if the mesh bounds a volume, pairs
// of triangles that cross each other.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <cstdio>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
namespace pmp = CGAL::Polygon_mesh_processing;

int main(int argc, char** argv) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> triangles;
  if (argc != 2 || !CGAL::IO::read_STL(argv[1], points, triangles)) return 1;
  pmp::merge_duplicate_points_in_polygon_soup(points, triangles);
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) {
    std::printf("%zu 0 0 0 0\n", triangles.size());
    return 0;
  }
  CGAL::Surface_mesh<Kernel::Point_3> mesh;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  std::size_t borders = 0;
  for (const auto edge : mesh.edges()) borders += mesh.is_border(edge);
  std::vector<std::pair<decltype(mesh)::Face_index, decltype(mesh)::Face_index>> crossed;
  pmp::self_intersections(mesh, std::back_inserter(crossed));
  const bool valid = mesh.is_valid() && CGAL::is_closed(mesh);
  const bool outward = valid && (!crossed.empty() || pmp::does_bound_a_volume(mesh));
  std::printf("%zu %d %zu %d %zu\n", triangles.size(), valid, borders, outward, crossed.size());
}
