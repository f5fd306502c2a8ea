#include "runtime/mesh/lattice/cube_cycles.h"

#include <set>

#include "tests/support/catch.h"

namespace fathom::cube_cycles_test {

using namespace fathom::runtime;

TEST_CASE("cube cycles: edges and faces agree about corners", "[mesh]") {
  for (int edge = 0; edge < kCubeEdges; ++edge) {
    const CubeEdge ends = cube_edge(edge);
    CHECK(edge_at(ends.axis, ends.lower) == edge);
    CHECK(edge_at(ends.axis, ends.upper()) == edge);
    CHECK((ends.lower >> ends.axis & 1) == 0);
  }
  for (int face = 0; face < kCubeFaces; ++face) {
    std::set<int> seen;
    for (const int corner : face_corners(face)) {
      CHECK((corner >> face / 2 & 1) == (face & 1));
      seen.insert(corner);
    }
    CHECK(seen.size() == 4);
  }
}

TEST_CASE("cube cycles: in all cases every crossing is in one cycle, which crosses each of its faces", "[mesh]") {
  int most = 0;
  for (unsigned inside = 0; inside < 256; ++inside) {
    for (unsigned open = 0; open < 64; ++open) {
      const CubeCycles cycles = trace_cycles(inside, open);
      int lengths[4] = {};
      for (int edge = 0; edge < kCubeEdges; ++edge) {
        const CubeEdge ends = cube_edge(edge);
        const bool crosses = (inside >> ends.lower & 1) != (inside >> ends.upper() & 1);
        const std::uint8_t cycle = cycles.cycle_of[static_cast<std::size_t>(edge)];
        REQUIRE(crosses == (cycle != CubeCycles::kNone));
        if (!crosses) continue;
        REQUIRE(cycle < cycles.count);
        ++lengths[cycle];
      }
      REQUIRE(cycles.count <= 4);
      for (int i = 0; i < cycles.count; ++i) REQUIRE(lengths[i] >= 3);
      most = std::max(most, cycles.count);
    }
  }
  CHECK(most == 4);
}

TEST_CASE("cube cycles: a centre inside the solid joins the diagonal corners of a face", "[mesh]") {
  // Corners 0 and 3 are inside, on the lower face across z.
  CHECK(trace_cycles(0b1001, 0).count == 2);
  CHECK(trace_cycles(0b1001, 1u << 4).count == 1);
}

}  // namespace fathom::cube_cycles_test
