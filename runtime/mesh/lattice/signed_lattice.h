// The signs of a field on a lattice: cells with their corners' signs, the edges that cross the surface, and the faces
// with diagonal signs.
// Tested by: tests/runtime/mesh/contour_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "runtime/mesh/lattice/cube_cycles.h"
#include "runtime/mesh/lattice/lattice.h"
#include "runtime/mesh/lattice/mesh_field.h"

namespace fathom::runtime {

// Answers if places are inside the solid, one byte each: corners, and centres of faces.
struct SignSource {
  using Answer = std::function<void(std::span<const LatticeKey> places, std::vector<std::uint8_t>& inside)>;
  Answer corners, face_centres;
};
// Answers from a field. Corners at the lattice's border are outside, so every surface is closed.
SignSource signs_of(const MeshField& field, const CellLattice& lattice, int threads);

class SignedLattice {
 public:
  // Reads the signs of the cells' corners. Adds every cell at an edge that crosses the surface, so that all four
  // cells of such an edge are there even if the constant of the field is wrong.
  SignedLattice(const std::vector<LatticeKey>& cells, const SignSource& source);

  const KeyMap& cells() const { return cells_; }
  // Bit i: corner i of the cell is inside the solid.
  unsigned inside(std::uint32_t cell) const { return inside_[cell]; }
  bool is_crossed(std::uint32_t cell) const { return inside_[cell] != 0 && inside_[cell] != 0xff; }
  const KeyMap& corners() const { return corners_; }
  bool is_corner_inside(std::uint32_t corner) const { return corner_inside_[corner] != 0; }
  // Edges whose ends have different signs, and true if the lower end is inside.
  const KeyMap& edges() const { return edges_; }
  bool is_lower_inside(std::uint32_t edge) const { return lower_inside_[edge] != 0; }
  // Faces with diagonal signs, each named by its lower corner and the axis across it.
  const KeyMap& ambiguous_faces() const { return faces_; }
  bool is_open(LatticeKey face) const { return open_[faces_.find(face)] != 0; }
  // Returns the corners of a cell's ambiguous face that the mesh connects across it; nullopt for other faces.
  std::optional<std::array<unsigned, 2>> joined_corners(std::uint32_t cell, int face) const;
  CubeCycles cycles(std::uint32_t cell) const;

 private:
  void read_corners(std::uint32_t first_cell, const SignSource& source);
  void find_edges(std::uint32_t first_cell, std::vector<LatticeKey>& missing);
  void find_faces(const SignSource& source);

  KeyMap cells_, corners_, edges_, faces_;
  std::vector<std::uint8_t> inside_;         // [cell]
  std::vector<std::uint8_t> corner_inside_;  // [corner]
  std::vector<std::uint8_t> lower_inside_;   // [edge]
  std::vector<std::uint8_t> open_;           // [face] 1 if the face's centre is inside
};

// Returns a face's key.
inline LatticeKey face_key(LatticePlace cell, int face) { return key_of(cell.moved(face / 2, face & 1), face / 2); }

// Returns the four cells around an edge, counter-clockwise seen from the edge's upper end.
std::array<LatticePlace, 4> cells_around(LatticePlace edge, int axis);

}  // namespace fathom::runtime
