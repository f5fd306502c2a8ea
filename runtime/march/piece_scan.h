// A first look at rays in scenes of few pieces: all pieces are tried for many rays at once, by their formulas or
// boxes (closed_form.h). It ends the rays that meet nothing, and those whose first entrance a formula proposes and
// the field confirms (piece_proposals.h). The others are marched. Not a public header: march.h is. Tested by:
// tests/runtime/march/piece_marcher_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/field/pieces.h"
#include "runtime/march/closed_form.h"
#include "runtime/march/piece_proposals.h"
#include "vm/interpret/workspace.h"

namespace fathom::runtime {

class PieceScan {
 public:
  // Above so many pieces a ray is faster in the tree of their boxes.
  static constexpr std::size_t kMostPieces = kMostScanned;

  // Requires at most kMostPieces.
  explicit PieceScan(const Pieces& pieces);

  struct Found {
    std::uint64_t others;  // bits of the pieces that may have a nearer root, or one next to it
    std::uint32_t piece;   // of the root, or kNoPiece
    double t;              // from the clipped ray's origin
    float width;           // of the root's bracket
    std::uint32_t evaluations;
    std::uint64_t instructions;
  };
  // Finds what the clipped rays from `first` on meet, of those that begin outside. Returns the number of points
  // evaluated.
  std::size_t scan(const RayBlock& rays, std::size_t first, vm::Workspace& workspace);
  // Returns what ray i meets.
  const Found& found(std::size_t i) const { return found_[i]; }
  void move(std::size_t from, std::size_t to) { found_[to] = found_[from]; }
  // Begins the visit of these pieces by a clipped ray (PieceBoxes::next).
  void list(std::uint64_t pieces, glm::dvec3 origin, glm::dvec3 direction, double length,
            PieceBoxes::Visit& visit) const;

 private:
  std::uint64_t all_but_left(std::uint32_t leaves) const;
  void sort_by_template(const RayBlock& rays, std::size_t first);
  std::size_t confirm(const RayBlock& rays, std::uint32_t shared, vm::Workspace& workspace);

  const Pieces& pieces_;
  std::vector<ScannedPiece> scanned_;                  // the largest first
  std::vector<std::unique_ptr<ProposedRoots>> roots_;  // [template]
  std::vector<std::vector<std::uint32_t>> entering_;   // [template] rays
  FirstMet met_;
  std::vector<Found> found_;  // [ray]
};

}  // namespace fathom::runtime
