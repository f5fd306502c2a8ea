#include "runtime/march/piece_proposals.h"

#include <algorithm>

namespace fathom::runtime {

PieceProposals::PieceProposals(const Pieces& pieces, std::uint32_t number)
    : pieces_(pieces), template_(pieces.templates[number]), pairs_(kCapacity) {
  static_assert(kPoints <= vm::kMaxRowLanes);
  if (template_.per_lane) constants_.resize(vm::constants_in(template_.code) * vm::kRowStride);
}

void PieceProposals::add(std::uint32_t ray, std::int32_t piece, glm::dvec3 origin, glm::dvec3 direction, double exit,
                         double reach) {
  pairs_[rays_.count] = {ray, piece, exit, reach};
  rays_.push(origin, direction, piece);
}

std::size_t PieceProposals::answer(std::vector<Answer>& answers, vm::Workspace& workspace) {
  answers.clear();
  entering_.clear();
  find_entrances(pieces_.forms.data(), !template_.per_lane, rays_);
  for (std::size_t i = 0; i < rays_.count; ++i) {
    const Meeting meeting = rays_.meeting_of(i);
    const double t = rays_.t[i], slack = rays_.slack[i];
    const bool enters = meeting == Meeting::Enters;
    if (meeting == Meeting::Misses || (enters && t - slack > pairs_[i].reach)) {
      answers.push_back({pairs_[i].ray, Result::Misses, false, 0, 0});
    } else if (!enters || t + slack >= pairs_[i].exit) {
      answers.push_back({pairs_[i].ray, Result::March, false, 0, 0});
    } else {
      add_points(i);
    }
  }
  const std::size_t count = 2 * entering_.size();
  rays_.count = 0;
  if (count == 0) return 0;
  template_.evaluate({points_[0], points_[1], points_[2]}, count, constants_.data(), distance_, scratch_, workspace);
  for (std::size_t k = 0; k < entering_.size(); ++k) answers.push_back(confirmed(entering_[k], 2 * k));
  return count;
}

// Adds the points before and after the root that the formula proposes for ray i.
void PieceProposals::add_points(std::size_t i) {
  const std::size_t first = 2 * entering_.size();
  entering_.push_back(i);
  const double before = rays_.t[i] - rays_.slack[i], after = rays_.t[i] + rays_.slack[i];
  for (int axis = 0; axis < 3; ++axis) {
    points_[axis][first] = static_cast<float>(rays_.origin[axis][i] + before * rays_.direction[axis][i]);
    points_[axis][first + 1] = static_cast<float>(rays_.origin[axis][i] + after * rays_.direction[axis][i]);
  }
  const std::vector<float>& row = pieces_.rows[static_cast<std::size_t>(pairs_[i].piece)];  // empty unless per_lane
  for (std::size_t k = 0; k < row.size(); ++k)
    constants_[k * vm::kRowStride + first] = constants_[k * vm::kRowStride + first + 1] = row[k];
}

// Returns the answer for ray i, whose points begin at `first`.
PieceProposals::Answer PieceProposals::confirmed(std::size_t i, std::size_t first) const {
  const std::size_t end = first + 1;
  const float before = distance_[first], after = distance_[end];
  const float error = distance_error(template_.field, points_[0][end], points_[1][end], points_[2][end], after);
  // The part of the way from `before` to 0.
  const double share = static_cast<double>(before) / (static_cast<double>(before) - static_cast<double>(after));
  const double t = rays_.t[i] + (2 * share - 1) * rays_.slack[i];
  const Result result = before > 0 && after < -error ? Result::Enters : Result::March;
  return {pairs_[i].ray, result, true, t, static_cast<float>(0x1p-22 * std::max(1.0, t))};
}

}  // namespace fathom::runtime
