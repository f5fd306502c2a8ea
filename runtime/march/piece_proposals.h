// Roots that formulas propose (closed_form.h), and that the field of a template's pieces confirms: its sign changes
// around them. Many proposals are looked at together.
// Not a public header: march.h is. Tested by: tests/runtime/march/piece_marcher_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "runtime/field/pieces.h"
#include "runtime/march/closed_form.h"
#include "vm/interpret/workspace.h"

namespace fathom::runtime {

class PieceProposals {
 public:
  static constexpr std::size_t kCapacity = Entrances::kCapacity;

  // `number`: of the template.
  PieceProposals(const Pieces& pieces, std::uint32_t number);

  std::size_t size() const { return rays_.count; }
  // Adds a ray that may enter a piece before `exit`, unless that is beyond `reach`. Requires size() < kCapacity.
  void add(std::uint32_t ray, std::int32_t piece, glm::dvec3 origin, glm::dvec3 direction, double exit, double reach);

  // March: the formula does not know, or the field does not confirm its root.
  enum class Result : std::uint8_t { Misses, Enters, March };
  struct Answer {
    std::uint32_t ray;
    Result result;
    bool evaluated;  // two points of the ray
    double t;        // of the root, if the ray enters the piece
    float width;     // of its bracket
  };
  // Moves all proposals to `answers`. Returns the number of points evaluated.
  std::size_t answer(std::vector<Answer>& answers, vm::Workspace& workspace);

 private:
  static constexpr std::size_t kPoints = 2 * kCapacity;  // the ends of a proposal are neighbours

  struct Pair {
    std::uint32_t ray;
    std::int32_t piece;
    double exit, reach;
  };
  void add_points(std::size_t i);
  Answer confirmed(std::size_t i, std::size_t first) const;

  const Pieces& pieces_;
  const PieceTemplate& template_;
  Entrances rays_;
  std::vector<Pair> pairs_;            // [ray of rays_]
  std::vector<std::size_t> entering_;  // rays with points, in their order
  alignas(64) float points_[3][kPoints] = {}, distance_[kPoints] = {};
  std::vector<float> constants_;  // [constant][point]
  RegionScratch scratch_;
};

}  // namespace fathom::runtime
