#include "runtime/mesh/contour.h"

#include "runtime/mesh/lattice/find_cells.h"
#include "tests/runtime/mesh/mesh_checks.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::contour_test {

namespace {

using namespace fathom::runtime;
using fathom::test::faults_of;
using fathom::test::MeshFaults;

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 31) * 0x9e3779b97f4a7c15;
  x = (x ^ x >> 29) * 0xbf58476d1ce4e5b9;
  return x ^ x >> 32;
}

// Random signs on a lattice of n cells per axis, outside at the border. `share` of 256 corners are inside.
SignSource random_signs(std::uint64_t seed, unsigned share, const CellLattice& lattice) {
  const auto sign = [=](LatticeKey key, unsigned among) { return mixed(key * 0x100000001b3 + seed) % 256 < among; };
  return {[=, &lattice](std::span<const LatticeKey> corners, std::vector<std::uint8_t>& inside) {
            inside.clear();
            for (const LatticeKey key : corners)
              inside.push_back(!lattice.is_border(place_of(key)) && sign(key, share));
          },
          [=](std::span<const LatticeKey> faces, std::vector<std::uint8_t>& inside) {
            inside.clear();
            for (const LatticeKey key : faces) inside.push_back(sign(~key, 128));
          }};
}

std::vector<LatticeKey> all_cells(const CellLattice& lattice) {
  std::vector<LatticeKey> cells;
  for (int z = 0; z < lattice.cells(2); ++z) {
    for (int y = 0; y < lattice.cells(1); ++y) {
      for (int x = 0; x < lattice.cells(0); ++x) cells.push_back(key_of({{x, y, z}}));
    }
  }
  return cells;
}

// Crossings in the middle of edges, with the axis as their normal.
std::vector<Crossing> middles(const CellLattice& lattice, const SignedLattice& signs) {
  std::vector<Crossing> crossings;
  for (std::uint32_t edge = 0; edge < signs.edges().size(); ++edge) {
    const LatticePlace place = place_of(signs.edges()[edge]);
    const int axis = axis_of(signs.edges()[edge]);
    Crossing at{0.5 * (glm::dvec3(lattice.corner(place)) + glm::dvec3(lattice.corner(place.moved(axis, 1)))), {}, 0};
    at.normal[axis] = signs.is_lower_inside(edge) ? 1 : -1;
    crossings.push_back(at);
  }
  return crossings;
}

}  // namespace

TEST_CASE("contour: random signs give closed manifolds, with every case of a cell and double edges", "[mesh]") {
  const CellLattice lattice = make_lattice({glm::dvec3(0), glm::dvec3(7)}, 1);
  REQUIRE(lattice.cells(0) >= 8);
  std::set<unsigned> cases;
  std::size_t on_faces = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const unsigned share = 32 + 48 * (seed % 5);
    const SignedLattice signs(all_cells(lattice), random_signs(seed, share, lattice));
    const Contour made = contour(lattice, signs, middles(lattice, signs));
    INFO("seed " << seed);
    REQUIRE(faults_of(made.mesh) == MeshFaults{});
    REQUIRE(made.quadrics.size() == made.mesh.vertices.size());
    std::size_t pieces = 0;
    for (std::uint32_t cell = 0; cell < signs.cells().size(); ++cell) {
      cases.insert(signs.inside(cell));
      pieces += static_cast<std::size_t>(signs.is_crossed(cell) ? signs.cycles(cell).count : 0);
    }
    on_faces += made.mesh.vertices.size() - pieces;
  }
  CHECK(cases.size() == 256);
  CHECK(on_faces > 100);  // the vertices that tell double edges apart
}

TEST_CASE("contour: a surface that its cells do not list is followed", "[mesh]") {
  const CellLattice lattice = make_lattice({glm::dvec3(0), glm::dvec3(12)}, 1);
  const auto scene = test::compiled_objects(R"({"type": "sphere", "radius": 5, "translate": [6, 6, 6]})");
  const Field prepared = make_field(scene);
  const MeshField field(prepared, compiler::Box::everything());
  const auto found = find_cells(field, lattice, 100000, 1);
  REQUIRE(!found.too_many);
  const SignSource source = signs_of(field, lattice, 1);
  const SignedLattice whole(found.cells, source);
  std::uint32_t first = 0;
  while (!whole.is_crossed(first)) ++first;
  const SignedLattice followed({found.cells[first]}, source);
  CHECK(followed.edges().size() == whole.edges().size());
  const Contour made = contour(lattice, followed, find_crossings(field, lattice, followed, 1));
  CHECK(faults_of(made.mesh) == MeshFaults{});
}

TEST_CASE("contour: crossings lie on the surface, with its normals", "[mesh]") {
  const auto scene = test::compiled_objects(R"({"type": "sphere", "radius": 1})");
  const Field prepared = make_field(scene);
  const MeshField field(prepared, compiler::Box::everything());
  const CellLattice lattice = make_lattice(scene.bound, 0.1);
  const SignedLattice signs(find_cells(field, lattice, 100000, 1).cells, signs_of(field, lattice, 1));
  const std::vector<Crossing> crossings = find_crossings(field, lattice, signs, 2);
  REQUIRE(crossings.size() > 1000);
  for (const Crossing& crossing : crossings) {
    REQUIRE(glm::length(crossing.position) == Approx(1).epsilon(1e-5));
    REQUIRE(glm::distance(crossing.normal, crossing.position) < 1e-5);
  }
}

TEST_CASE("lattice: keys and places, and cells that floats do not tell apart", "[mesh]") {
  const LatticePlace place{{5, 1 << 19, 77}};
  CHECK(place_of(key_of(place, 2)).at == place.at);
  CHECK(axis_of(key_of(place, 2)) == 2);
  CHECK(make_lattice({glm::dvec3(1000), glm::dvec3(1001)}, 1e-6).cell == 0);
  CHECK(make_lattice({glm::dvec3(0), glm::dvec3(1)}, 0.1).cell == 0.1);
  KeyMap map;
  for (LatticeKey key = 0; key < 5000; ++key) REQUIRE(map.insert(key * key) == key);
  CHECK(map.insert(49) == 7);
  CHECK(map.find(50) == KeyMap::kNone);
  CHECK(map.size() == 5000);
}

}  // namespace fathom::contour_test
