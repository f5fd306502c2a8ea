#include "runtime/mesh/lattice/cube_cycles.h"

namespace fathom::runtime {
namespace {

// Returns the edge between two corners of a face that follow each other.
int edge_between(int a, int b) {
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  return edge_at(axis, a & b);
}

// Returns the face on which the arc that starts at `edge` lies: the one of the edge's two faces around which a walk,
// counter-clockwise seen from outside, leaves the solid at the edge.
int face_of_start(unsigned inside, int edge) {
  for (int face = 0; face < kCubeFaces; ++face) {
    const std::array<int, 4> corners = face_corners(face);
    for (std::size_t i = 0; i < 4; ++i) {
      const int from = corners[i], to = corners[(i + 1) % 4];
      if (edge_between(from, to) == edge && (inside >> from & 1) && !(inside >> to & 1)) return face;
    }
  }
  return -1;
}

}  // namespace

int end_of_arc(unsigned inside, int face, int start, bool open) {
  const std::array<int, 4> corners = face_corners(face);
  std::size_t at = 0;
  while (edge_between(corners[at], corners[(at + 1) % 4]) != start) ++at;
  // An arc of an open face goes around an outer corner, and one of a closed face around an inner corner: the next
  // edge on which the walk enters the solid, or the previous one. Both are the same unless the signs are diagonal.
  const std::size_t step = open ? 1 : 3;
  for (std::size_t i = (at + step) % 4; i != at; i = (i + step) % 4) {
    const int from = corners[i], to = corners[(i + 1) % 4];
    if (!(inside >> from & 1) && (inside >> to & 1)) return edge_between(from, to);
  }
  return -1;
}

CubeCycles trace_cycles(unsigned inside, unsigned open_faces) {
  CubeCycles cycles{};
  cycles.cycle_of.fill(CubeCycles::kNone);
  for (int first = 0; first < kCubeEdges; ++first) {
    const CubeEdge ends = cube_edge(first);
    const bool crosses = (inside >> ends.lower & 1) != (inside >> ends.upper() & 1);
    if (!crosses || cycles.cycle_of[static_cast<std::size_t>(first)] != CubeCycles::kNone) continue;
    int edge = first;
    do {
      cycles.cycle_of[static_cast<std::size_t>(edge)] = static_cast<std::uint8_t>(cycles.count);
      const int face = face_of_start(inside, edge);
      edge = end_of_arc(inside, face, edge, open_faces >> face & 1);
    } while (edge != first);
    ++cycles.count;
  }
  return cycles;
}

}  // namespace fathom::runtime
