#include "runtime/march/piece_proposals.h"

#include <algorithm>

namespace fathom::runtime {

ProposedRoots::ProposedRoots(const Pieces& pieces, std::uint32_t number)
    : pieces_(pieces), template_(pieces.templates[number]), t_(kCapacity), slack_(kCapacity) {
  static_assert(kPoints <= vm::kMaxRowLanes);
  if (template_.per_lane) constants_.resize(vm::constants_in(template_.code) * vm::kRowStride);
}

void ProposedRoots::add(std::size_t piece, glm::dvec3 origin, glm::dvec3 direction, double t, double slack) {
  const std::size_t first = 2 * count_;
  t_[count_] = t, slack_[count_] = slack;
  ++count_;
  for (int axis = 0; axis < 3; ++axis) {
    points_[axis][first] = static_cast<float>(origin[axis] + (t - slack) * direction[axis]);
    points_[axis][first + 1] = static_cast<float>(origin[axis] + (t + slack) * direction[axis]);
  }
  const std::vector<float>& row = pieces_.rows[piece];  // empty unless per_lane
  for (std::size_t k = 0; k < row.size(); ++k)
    constants_[k * vm::kRowStride + first] = constants_[k * vm::kRowStride + first + 1] = row[k];
}

std::size_t ProposedRoots::evaluate(vm::Workspace& workspace) {
  const std::size_t points = 2 * count_;
  count_ = 0;
  if (points > 0)
    template_.evaluate({points_[0], points_[1], points_[2]}, points, constants_.data(), distance_, scratch_,
                       workspace);
  return points;
}

ProposedRoots::Root ProposedRoots::root(std::size_t i) const {
  const std::size_t end = 2 * i + 1;
  const float before = distance_[2 * i], after = distance_[end];
  const float error = distance_error(template_.field, points_[0][end], points_[1][end], points_[2][end], after);
  // The part of the way from `before` to 0.
  const double share = static_cast<double>(before) / (static_cast<double>(before) - static_cast<double>(after));
  const double t = t_[i] + (2 * share - 1) * slack_[i];
  return {before > 0 && after < -error, t, static_cast<float>(0x1p-22 * std::max(1.0, t))};
}

PieceProposals::PieceProposals(const Pieces& pieces, std::uint32_t number)
    : pieces_(pieces), template_(pieces.templates[number]), pairs_(kCapacity), roots_(pieces, number) {}

void PieceProposals::add(std::uint32_t ray, std::int32_t piece, glm::dvec3 origin, glm::dvec3 direction,
                         double reach) {
  pairs_[rays_.count] = {ray, piece, reach};
  rays_.push(origin, direction, pieces_.first_form[static_cast<std::size_t>(piece)]);
}

std::size_t PieceProposals::answer(std::vector<Answer>& answers, vm::Workspace& workspace) {
  answers.clear();
  proposers_.clear();
  if (rays_.count > 0) {
    const auto piece = static_cast<std::size_t>(pairs_[0].piece);
    find_entrances(pieces_.forms, pieces_.forms_of(piece).size(), !template_.per_lane, rays_);
  }
  for (std::size_t i = 0; i < rays_.count; ++i) {
    const Meeting meeting = rays_.meeting_of(i);
    const Pair& pair = pairs_[i];
    if (meeting == Meeting::Misses || (meeting == Meeting::Enters && rays_.t[i] - rays_.slack[i] > pair.reach)) {
      answers.push_back({pair.ray, Result::Misses, false, 0, 0});
    } else if (meeting == Meeting::Uncertain) {
      answers.push_back({pair.ray, Result::March, false, 0, 0});
    } else {
      proposers_.push_back(pair.ray);
      roots_.add(static_cast<std::size_t>(pair.piece), rays_.origin_of(i), rays_.direction_of(i), rays_.t[i],
                 rays_.slack[i]);
    }
  }
  rays_.count = 0;
  const std::size_t points = roots_.evaluate(workspace);
  for (std::size_t k = 0; k < proposers_.size(); ++k) {
    const ProposedRoots::Root root = roots_.root(k);
    answers.push_back({proposers_[k], root.confirmed ? Result::Enters : Result::March, true, root.t, root.width});
  }
  return points;
}

}  // namespace fathom::runtime
