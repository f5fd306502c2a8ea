// The pieces of the surface in one cell of the lattice, from the signs at the cell's corners.
//
// On each face of the cell, arcs separate the corners inside the solid from those outside. The arcs of all faces join
// to cycles, one for each piece of the surface. A face with diagonal signs has two arcs, which can be joined in two
// ways: `open_faces` says for each face if its centre is inside the solid, which both cells of the face know.
//
// Corner i of a cell lies at (i & 1, i >> 1 & 1, i >> 2). Edge 4 a + k lies along axis a; k counts its two positions
// along the next two axes. Face 2 a is the lower one across axis a, face 2 a + 1 the upper one.
//
// Sources: Nielson, "Dual marching cubes", 2004; Wenger, "Isosurfaces: geometry, topology, and algorithms", 2013.
// Tested by: tests/runtime/mesh/cube_cycles_test.cpp
#pragma once

#include <array>
#include <cstdint>

namespace fathom::runtime {

inline constexpr int kCubeEdges = 12, kCubeFaces = 6;

struct CubeEdge {
  std::uint8_t axis, lower;  // the lower corner
  std::uint8_t upper() const { return static_cast<std::uint8_t>(lower | 1 << axis); }
};
inline constexpr CubeEdge cube_edge(int edge) {
  const int axis = edge / 4, next = (axis + 1) % 3, last = (axis + 2) % 3;
  return {static_cast<std::uint8_t>(axis), static_cast<std::uint8_t>((edge & 1) << next | (edge >> 1 & 1) << last)};
}
// Returns the edge along `axis` that contains `corner`.
inline constexpr int edge_at(int axis, int corner) {
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  return 4 * axis + (corner >> next & 1) + 2 * (corner >> last & 1);
}

// A face's corners, counter-clockwise seen from outside the cell.
inline constexpr std::array<int, 4> face_corners(int face) {
  const int axis = face / 2, upper = face & 1, base = upper << axis;
  const int next = 1 << (axis + 1) % 3, last = 1 << (axis + 2) % 3;
  return upper ? std::array<int, 4>{base, base | next, base | next | last, base | last}
               : std::array<int, 4>{base, base | last, base | next | last, base | next};
}

// True if the signs of the face's corners are diagonal. Bit i of `inside`: corner i is in the solid.
inline constexpr bool is_ambiguous(unsigned inside, int face) {
  const std::array<int, 4> corners = face_corners(face);
  const auto at = [&](std::size_t i) { return inside >> corners[i] & 1; };
  return at(0) == at(2) && at(1) == at(3) && at(0) != at(1);
}

// The edge at which an arc on a face ends, given the edge at which it starts: the edge that a walk around the face,
// counter-clockwise seen from outside, crosses out of the solid.
int end_of_arc(unsigned inside, int face, int start, bool open);

struct CubeCycles {
  static constexpr std::uint8_t kNone = 0xff;
  std::array<std::uint8_t, kCubeEdges> cycle_of;  // [edge] number of the cycle, or kNone if the edge has no crossing
  int count = 0;                                  // at most four
};
CubeCycles trace_cycles(unsigned inside, unsigned open_faces);

}  // namespace fathom::runtime
