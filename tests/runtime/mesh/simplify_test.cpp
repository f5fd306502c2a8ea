#include "runtime/mesh/simplify.h"

#include "tests/runtime/mesh/mesh_checks.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::simplify_test {

namespace {

using namespace fathom::runtime;
using fathom::test::faults_of;
using fathom::test::meshed;
using fathom::test::MeshFaults;

}  // namespace

TEST_CASE("simplify: a box becomes its corners, and keeps its volume", "[mesh]") {
  const auto scene = test::compiled_objects(R"({"type": "box", "half_size": [1, 0.6, 0.4], "rotate": [20, 30, 10]})");
  const MeshResult result = meshed(scene, 48);
  REQUIRE(result.end == MeshResult::End::Done);
  CHECK(faults_of(result.mesh) == MeshFaults{});
  CHECK(result.mesh.triangles.size() < 200);
  CHECK(result.contour_triangles > 10000);
  CHECK(measure(result.mesh).volume == Approx(1.92).epsilon(1e-3));
  // All eight corners are vertices.
  const auto upright = test::compiled_objects(R"({"type": "box", "half_size": [1, 0.6, 0.4]})");
  const MeshResult plain = meshed(upright, 48);
  for (unsigned i = 0; i < 8; ++i) {
    const glm::dvec3 corner((i & 1 ? 1 : -1) * 1.0, (i & 2 ? 1 : -1) * 0.6, (i & 4 ? 1 : -1) * 0.4);
    double nearest = 1;
    for (const glm::dvec3& v : plain.mesh.vertices) nearest = std::min(nearest, glm::distance(v, corner));
    CHECK(nearest < 1e-4);
  }
}

TEST_CASE("simplify: borders of materials stay where they are", "[mesh]") {
  const auto scene = test::compiled(R"({"version": 1,
    "materials": {"red": {"type": "diffuse", "color": [1, 0, 0]}, "blue": {"type": "diffuse", "color": [0, 0, 1]}},
    "objects": [{"type": "box", "half_size": [0.5, 0.5, 0.5], "material": "red"},
                {"type": "box", "half_size": [0.5, 0.5, 0.5], "translate": [1, 0, 0], "material": "blue"}]})");
  const MeshResult result = meshed(scene, 40);
  REQUIRE(result.end == MeshResult::End::Done);
  CHECK(faults_of(result.mesh) == MeshFaults{});
  double areas[2] = {};
  for (const Triangle& triangle : result.mesh.triangles) {
    const auto p = result.mesh.corners(triangle);
    const double middle = (p[0].x + p[1].x + p[2].x) / 3;
    const auto material = scene.surfaces[triangle.surface].material;
    areas[material] += 0.5 * glm::length(area_normal(p));
    CHECK(std::abs(middle - 0.5) * (material == (middle < 0.5 ? 0u : 1u) ? 0 : 1) < 2 * result.cell);
  }
  CHECK(areas[0] == Approx(5).epsilon(0.02));
  CHECK(areas[1] == Approx(5).epsilon(0.02));
}

}  // namespace fathom::simplify_test
