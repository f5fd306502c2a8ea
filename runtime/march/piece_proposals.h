// Roots that formulas propose (closed_form.h), and that the field of a template's pieces confirms: its sign changes
// around them. Many proposals are looked at together.
// Not a public header: march.h is. Tested by: tests/runtime/march/piece_marcher_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "runtime/field/pieces.h"
#include "vm/interpret/workspace.h"

namespace fathom::runtime {

class PieceProposals {
 public:
  static constexpr std::size_t kCapacity = 384;

  // `number`: of the template.
  PieceProposals(const Pieces& pieces, std::uint32_t number);

  std::size_t size() const { return rays_.size(); }
  // Adds a root at t of the ray with this number, known to within `slack`. Requires size() < kCapacity.
  void add(std::uint32_t ray, std::uint32_t piece, glm::dvec3 origin, glm::dvec3 direction, double t, double slack);

  struct Answer {
    std::uint32_t ray;
    bool confirmed;
    double t;     // of the root, if confirmed
    float width;  // of its bracket
  };
  // Moves all proposals to `answers`.
  void answer(std::vector<Answer>& answers, vm::Workspace& workspace);

 private:
  static constexpr std::size_t kPoints = 2 * kCapacity;  // the ends of a proposal are neighbours

  const Pieces& pieces_;
  const PieceTemplate& template_;
  struct Ray {
    std::uint32_t number;
    double t, slack;
  };
  std::vector<Ray> rays_;
  alignas(64) float points_[3][kPoints] = {}, distance_[kPoints] = {};
  std::vector<float> constants_;  // [constant][point]
  RegionScratch scratch_;
};

}  // namespace fathom::runtime
