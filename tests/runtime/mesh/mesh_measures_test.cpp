#include "runtime/mesh/mesh_measures.h"

#include "tests/support/catch.h"

namespace fathom::mesh_measures_test {

namespace {

using namespace fathom::runtime;

// Adds a tetrahedron with edges along the axes, turned inside out on request.
void add_corner(TriangleMesh& mesh, glm::dvec3 at, glm::dvec3 size, bool inward = false) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const glm::dvec3 corner : {glm::dvec3(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
    mesh.vertices.push_back(at + size * corner);
  }
  for (std::array<std::uint32_t, 3> t : {std::array{0u, 2u, 1u}, {0u, 1u, 3u}, {0u, 3u, 2u}, {1u, 2u, 3u}}) {
    if (inward) std::swap(t[0], t[1]);
    mesh.triangles.push_back({{t[0] + first, t[1] + first, t[2] + first}, 0});
  }
}

}  // namespace

// A box and its lid were told as "2 components", which were one body and one hollow.
TEST_CASE("mesh measures: bodies and hollows are told apart by their volumes", "[mesh]") {
  TriangleMesh mesh;
  add_corner(mesh, {0, 0, 0}, glm::dvec3(10));
  add_corner(mesh, {1, 1, 1}, glm::dvec3(2), true);
  add_corner(mesh, {20, 0, 0}, glm::dvec3(1));
  const MeshMeasures measures = measure(mesh);
  CHECK(measures.bodies == 2);
  CHECK(measures.hollows == 1);
  CHECK(measures.volume == Approx((1000 - 8 + 1) / 6.0));
}

TEST_CASE("mesh measures: triangles that cut each other are counted in pairs, on any number of threads", "[mesh]") {
  TriangleMesh mesh;
  for (int i = 0; i < 100; ++i) add_corner(mesh, glm::dvec3(3 * i, 0, 0), glm::dvec3(1));
  CHECK(count_crossings(mesh, 1) == 0);
  add_corner(mesh, {30.25, 0.25, -0.5}, glm::dvec3(0.25, 0.25, 4));  // a needle through the floor and the slope
  // Each of its four sides but the short ones cuts the floor, and the slope twice or once.
  CHECK(count_crossings(mesh, 1) == 6);
  CHECK(count_crossings(mesh, 3) == 6);
}

TEST_CASE("mesh measures: triangles that touch do not cross", "[mesh]") {
  TriangleMesh mesh;
  add_corner(mesh, {0, 0, 0}, glm::dvec3(1));
  add_corner(mesh, {0, 0, 0}, glm::dvec3(-1));  // at a corner
  add_corner(mesh, {0, 0, 1}, glm::dvec3(1));   // at another
  CHECK(count_crossings(mesh, 1) == 0);
}

TEST_CASE("mesh measures: a fold has its two triangles turned over on each other", "[mesh]") {
  TriangleMesh mesh;
  add_corner(mesh, {0, 0, 0}, {1, 1, 1});
  CHECK(count_folds(mesh) == 0);
  mesh = {};
  add_corner(mesh, {0, 0, 0}, {1, 1, 1e-4});  // the slope lies on the floor along one edge
  CHECK(count_folds(mesh) == 1);
}

}  // namespace fathom::mesh_measures_test
