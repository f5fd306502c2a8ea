// The C++ interface of the library: meshes.
#include <algorithm>
#include <cmath>
#include <fathom/fathom.hpp>
#include <set>
#include <utility>

#include "tests/support/catch.h"

namespace fathom::library_mesh_test {

namespace {

Scene compiled(std::string_view text) {
  Compiled out = compile(text);
  INFO(out.error.message);
  REQUIRE(out.scene);
  return out.scene;
}

// True if every edge has one triangle on each side.
bool is_closed(const Mesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!edges.insert({t[i], t[(i + 1) % 3]}).second) return false;
    }
  }
  return std::ranges::all_of(edges, [&](const auto& edge) { return edges.contains({edge.second, edge.first}); });
}

}  // namespace

TEST_CASE("a mesh of the library is closed, near and where the scene is", "[library]") {
  const Scene scene = compiled(
      "fathom 1\nobject \"far\" sphere(1).translate([1e5, 0, 0])\nobject \"box\" box([1, 1, 1]).translate([1e5, 5, 0])\n");
  MeshOptions options;
  options.tolerance = 0.05;
  const Meshed made = scene.mesh(options);
  INFO(made.error.message);
  REQUIRE_FALSE(made.error);
  CHECK(is_closed(made.mesh));
  CHECK(made.mesh.proved);
  CHECK(made.mesh.bound <= 0.05);
  CHECK(made.mesh.objects.size() == made.mesh.triangles.size());
  std::vector<double> distance(made.mesh.vertices.size());
  REQUIRE_FALSE(scene.distance(Points<double>(made.mesh.vertices), distance));
  for (const double d : distance) CHECK(std::abs(d) <= made.mesh.bound);
  CHECK(std::set(made.mesh.objects.begin(), made.mesh.objects.end()) == std::set<std::uint32_t>{0, 1});
}

TEST_CASE("a scene without end is meshed in a box", "[library]") {
  const Scene scene = compiled("fathom 1\nobject \"ground\" plane([0, 1, 0])\n");
  CHECK(scene.mesh().error.kind == Error::Kind::BadArgument);
  MeshOptions options;
  options.resolution = 16;
  options.box = {{-1, -1, -1}, {1, 1, 1}};
  const Meshed made = scene.mesh(options);
  REQUIRE_FALSE(made.error);
  CHECK(is_closed(made.mesh));
  options.box = {{-1, 2, -1}, {1, 3, 1}};
  CHECK(scene.mesh(options).error.kind == Error::Kind::BadArgument);
  options.box.reset();
  options.resolution = 3;
  CHECK(scene.mesh(options).error.kind == Error::Kind::BadArgument);
  options.tolerance = -1.0;
  CHECK(scene.mesh(options).error.kind == Error::Kind::BadArgument);
  CHECK(Scene().mesh().error.kind == Error::Kind::BadArgument);
}

TEST_CASE("the library names parts that a mesh loses", "[library]") {
  const Scene scene = compiled(
      "fathom 1\nobject \"ball\" sphere(1)\nobject \"sheet\" box([1, 0.004, 1]).translate([0.003, 2, 0.002])\n");
  MeshOptions options;
  options.resolution = 32;
  const Meshed made = scene.mesh(options);
  REQUIRE_FALSE(made.error);
  std::vector<std::string> names;
  REQUIRE_FALSE(scene.objects(names));
  REQUIRE(made.mesh.lost.size() == 1);
  CHECK(names[made.mesh.lost[0].object] == "sheet");
  CHECK_FALSE(made.mesh.lost[0].gap);
  CHECK(made.mesh.lost[0].place.y == Approx(2).margin(0.01));
}

}  // namespace fathom::library_mesh_test
