#include "runtime/march/piece_proposals.h"

#include <algorithm>

namespace fathom::runtime {

PieceProposals::PieceProposals(const Pieces& pieces, std::uint32_t number)
    : pieces_(pieces), template_(pieces.templates[number]) {
  static_assert(kPoints <= vm::kMaxRowLanes);
  if (template_.per_lane) constants_.resize(vm::constants_in(template_.code) * vm::kRowStride);
}

void PieceProposals::add(std::uint32_t ray, std::uint32_t piece, glm::dvec3 origin, glm::dvec3 direction, double t,
                         double slack) {
  const std::size_t first = 2 * rays_.size();
  rays_.push_back({ray, t, slack});
  const glm::dvec3 before = origin + (t - slack) * direction, after = origin + (t + slack) * direction;
  for (int axis = 0; axis < 3; ++axis) {
    points_[axis][first] = static_cast<float>(before[axis]);
    points_[axis][first + 1] = static_cast<float>(after[axis]);
  }
  const std::vector<float>& row = pieces_.rows[piece];  // empty unless lanes have constants
  for (std::size_t k = 0; k < row.size(); ++k) {
    constants_[k * vm::kRowStride + first] = constants_[k * vm::kRowStride + first + 1] = row[k];
  }
}

void PieceProposals::answer(std::vector<Answer>& answers, vm::Workspace& workspace) {
  const std::size_t count = 2 * rays_.size();
  template_.evaluate({points_[0], points_[1], points_[2]}, count, constants_.data(), distance_, scratch_, workspace);
  answers.clear();
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const Ray& ray = rays_[i];
    const std::size_t end = 2 * i + 1;
    const float before = distance_[2 * i], after = distance_[end];
    const float error = distance_error(template_.field, points_[0][end], points_[1][end], points_[2][end], after);
    // The part of the way from `before` to 0.
    const double share = static_cast<double>(before) / (static_cast<double>(before) - static_cast<double>(after));
    const double t = ray.t + (2 * share - 1) * ray.slack;
    answers.push_back({ray.number, before > 0 && after < -error, t, static_cast<float>(0x1p-22 * std::max(1.0, t))});
  }
  rays_.clear();
}

}  // namespace fathom::runtime
