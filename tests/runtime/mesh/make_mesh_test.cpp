#include "runtime/mesh/make_mesh.h"

#include "tests/runtime/mesh/mesh_checks.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::make_mesh_test {

namespace {

using namespace fathom::runtime;
using fathom::test::faults_of;
using fathom::test::largest_distance;
using fathom::test::meshed;
using fathom::test::MeshFaults;

double sphere(glm::dvec3 p) { return glm::length(p) - 1; }
double torus(glm::dvec3 p) { return std::hypot(std::hypot(p.x, p.z) - 1, p.y) - 0.3; }
// Distance from the surface of a box of half sizes 1, 0.6 and 0.4, on both sides.
double box(glm::dvec3 p) {
  const glm::dvec3 q = glm::abs(p) - glm::dvec3(1, 0.6, 0.4);
  return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

}  // namespace

TEST_CASE("mesh: points of the mesh are within the proved bound of closed forms", "[mesh]") {
  struct Case {
    const char* object;
    double (*distance)(glm::dvec3);
    double volume;
  };
  const Case cases[] = {{R"({"type": "sphere", "radius": 1})", sphere, 4.18879},
                        {R"({"type": "torus", "major_radius": 1, "minor_radius": 0.3})", torus, 1.77653},
                        {R"({"type": "box", "half_size": [1, 0.6, 0.4]})", box, 1.92}};
  for (const Case& scene_case : cases) {
    const auto scene = test::compiled_objects(scene_case.object);
    for (const bool simplifies : {false, true}) {
      const MeshResult result = meshed(scene, 40, simplifies);
      REQUIRE(result.end == MeshResult::End::Done);
      INFO(scene_case.object << (simplifies ? ", simplified" : ""));
      CHECK(faults_of(result.mesh) == MeshFaults{});
      CHECK(largest_distance(result.mesh, scene_case.distance) <= result.bound);
      CHECK(result.bound < 0.5 * result.cell);
      CHECK(measure(result.mesh).bodies == 1);
      CHECK(measure(result.mesh).volume == Approx(scene_case.volume).epsilon(0.015));
      CHECK(result.lost.empty());
    }
  }
}

TEST_CASE("mesh: a coarse tolerance holds for the whole mesh", "[mesh]") {
  const auto scene = test::compiled_objects(R"({"type": "torus", "major_radius": 1, "minor_radius": 0.3})");
  MeshOptions options;
  options.tolerance = options.deviation = 0.08;
  options.memory = 1e9;
  const MeshResult result = make_mesh(scene, scene.bound, options);
  CHECK(result.bound <= 0.08);
  CHECK(largest_distance(result.mesh, torus) <= 0.08);
  CHECK(faults_of(result.mesh) == MeshFaults{});
  CHECK(result.mesh.triangles.size() < 900);
}

TEST_CASE("mesh: any number of threads gives the same bits", "[mesh]") {
  const auto scene = test::compiled_objects(
      R"({"type": "smooth_union", "k": 0.2, "of": [{"type": "sphere", "radius": 1},
          {"type": "box", "half_size": [1.4, 0.3, 0.3], "rotate": [10, 20, 30]}]})");
  const MeshResult one = meshed(scene, 60, true, 1), four = meshed(scene, 60, true, 4);
  REQUIRE(one.mesh.triangles.size() == four.mesh.triangles.size());
  CHECK(one.mesh.vertices == four.mesh.vertices);
  CHECK(one.bound == four.bound);
  for (std::size_t i = 0; i < one.mesh.triangles.size(); ++i) {
    REQUIRE(one.mesh.triangles[i].vertices == four.mesh.triangles[i].vertices);
  }
}

TEST_CASE("mesh: a solid cut off at a box is closed", "[mesh]") {
  const auto scene = test::compiled(R"({"version": 1, "objects": [{"type": "plane", "normal": [0, 1, 0]},
    {"type": "gyroid", "period": 1}]})");
  MeshOptions options;
  const compiler::Box cut{{-1, -0.5, -1}, {1, 0.7, 1}};
  options.tolerance = tolerance_of(cut, 40);
  options.deviation = fine_deviation(options.tolerance);
  options.is_clipped = true;
  options.memory = 1e9;
  const MeshResult result = make_mesh(scene, cut, options);
  REQUIRE(result.end == MeshResult::End::Done);
  CHECK(faults_of(result.mesh) == MeshFaults{});
  compiler::Box extent;
  for (const glm::dvec3& v : result.mesh.vertices) extent = unite(extent, {v, v});
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(extent.lo[axis] == Approx(cut.lo[axis]).margin(result.bound));
    CHECK(extent.hi[axis] == Approx(cut.hi[axis]).margin(result.bound));
  }
}

TEST_CASE("mesh: an estimated constant leaves no hole", "[mesh]") {
  const auto scene = test::compiled_objects(R"({"type": "mandelbulb", "iterations": 4})");
  const MeshResult result = meshed(scene, 48);
  REQUIRE(result.end == MeshResult::End::Done);
  CHECK(faults_of(result.mesh) == MeshFaults{});
}

TEST_CASE("mesh: too many cells, too small cells and no surface are told apart", "[mesh]") {
  const auto scene = test::compiled_objects(R"({"type": "sphere", "radius": 1})");
  MeshOptions options;
  options.tolerance = options.deviation = 0.001;
  options.memory = 1e6;
  const MeshResult many = make_mesh(scene, scene.bound, options);
  CHECK(many.end == MeshResult::End::TooMany);
  CHECK(many.memory > 1e6);
  options.tolerance = options.deviation = 1e-8;
  CHECK(make_mesh(scene, scene.bound, options).end == MeshResult::End::TooFine);
  const auto thin = test::compiled_objects(R"({"name": "leaf", "type": "box", "half_size": [1, 0.0001, 1]})");
  const MeshResult empty = meshed(thin, 16);
  CHECK(empty.end == MeshResult::End::Empty);
  REQUIRE(empty.lost.size() == 1);
}

}  // namespace fathom::make_mesh_test
