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

// Roots of rays in the pieces of one template, each a bracket of which the field is to confirm that it is entered
// there.
class ProposedRoots {
 public:
  static constexpr std::size_t kCapacity = Entrances::kCapacity;

  // `number`: of the template.
  ProposedRoots(const Pieces& pieces, std::uint32_t number);

  std::size_t size() const { return count_; }
  // Adds the bracket from t - slack to t + slack on a ray. Requires size() < kCapacity.
  void add(std::size_t piece, glm::dvec3 origin, glm::dvec3 direction, double t, double slack);
  // Evaluates the field at the ends of all brackets. Returns the number of points. The next root is the first again.
  std::size_t evaluate(vm::Workspace& workspace);
  struct Root {
    bool confirmed;
    double t;
    float width;  // of its bracket
  };
  // Returns root number i of those that were evaluated last.
  Root root(std::size_t i) const;

 private:
  static constexpr std::size_t kPoints = 2 * kCapacity;  // the ends of a bracket are neighbours

  const Pieces& pieces_;
  const PieceTemplate& template_;
  std::size_t count_ = 0;
  std::vector<double> t_, slack_;  // [root]
  alignas(64) float points_[3][kPoints] = {}, distance_[kPoints] = {};
  std::vector<float> constants_;  // [constant][point]
  RegionScratch scratch_;
};

class PieceProposals {
 public:
  static constexpr std::size_t kCapacity = Entrances::kCapacity;

  // `number`: of the template.
  PieceProposals(const Pieces& pieces, std::uint32_t number);

  std::size_t size() const { return rays_.count; }
  // Adds a ray that may enter a piece, unless beyond `reach`. Requires size() < kCapacity.
  void add(std::uint32_t ray, std::int32_t piece, glm::dvec3 origin, glm::dvec3 direction, double reach);

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
  struct Pair {
    std::uint32_t ray;
    std::int32_t piece;
    double reach;
  };

  const Pieces& pieces_;
  const PieceTemplate& template_;
  Entrances rays_;
  std::vector<Pair> pairs_;               // [ray of rays_]
  std::vector<std::uint32_t> proposers_;  // rays of roots_
  ProposedRoots roots_;
};

}  // namespace fathom::runtime
