#include "runtime/march/piece_scan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "runtime/march/clip.h"

namespace fathom::runtime {
namespace {

double size_of(const compiler::Box& box) {
  const glm::dvec3 sides = glm::min(box.hi - box.lo, 1e30);
  return sides.x * sides.y + sides.y * sides.z + sides.z * sides.x;
}

}  // namespace

PieceScan::PieceScan(const Pieces& pieces)
    : pieces_(pieces),
      roots_(pieces.templates.size()),
      entering_(pieces.templates.size()),
      found_(RayBlock::kCapacity) {
  for (std::uint32_t i = 0; i < pieces.fields.size(); ++i) {
    const auto forms = pieces.forms_of(i);
    const bool moved =
        std::ranges::all_of(forms, [](const compiler::ClosedForm& form) { return form.linear == glm::dmat3(1.0); });
    scanned_.push_back({forms, pieces.fields[i].bound, moved, pieces.templates[pieces.template_of[i]].convex, i});
  }
  std::ranges::stable_sort(scanned_, std::greater<>(), [](const ScannedPiece& piece) { return size_of(piece.box); });
}

std::size_t PieceScan::scan(const RayBlock& rays, std::size_t first, vm::Workspace& workspace) {
  find_first(scanned_, rays, first, met_);
  sort_by_template(rays, first);
  std::size_t points = 0;
  for (std::uint32_t shared = 0; shared < entering_.size(); ++shared) points += confirm(rays, shared, workspace);
  return points;
}

void PieceScan::sort_by_template(const RayBlock& rays, std::size_t first) {
  for (auto& entering : entering_) entering.clear();
  for (std::size_t i = first; i < rays.count; ++i) {
    found_[i] = {met_.others[i], kNoPiece, 0, 0, 0, 0};
    if (met_.piece[i] < 0 || rays.clip_result(i) != ClipResult::Within || rays.side[i] < 0) continue;
    const auto piece = static_cast<std::uint32_t>(met_.piece[i]);
    entering_[pieces_.template_of[piece]].push_back(static_cast<std::uint32_t>(i));
  }
}

// Returns the bits of all pieces, without one that the ray leaves and does not meet again.
std::uint64_t PieceScan::all_but_left(std::uint32_t leaves) const {
  const std::uint64_t all = (std::uint64_t{1} << scanned_.size()) - 1;
  const bool stays_away =
      leaves < pieces_.template_of.size() && pieces_.templates[pieces_.template_of[leaves]].convex;
  return stays_away ? all & ~(std::uint64_t{1} << leaves) : all;
}

// Has the field confirm the entrances into pieces of one template.
std::size_t PieceScan::confirm(const RayBlock& rays, std::uint32_t shared, vm::Workspace& workspace) {
  const std::vector<std::uint32_t>& entering = entering_[shared];
  if (entering.empty()) return 0;
  if (!roots_[shared]) roots_[shared] = std::make_unique<ProposedRoots>(pieces_, shared);
  ProposedRoots& roots = *roots_[shared];
  std::size_t points = 0;
  for (std::size_t begin = 0; begin < entering.size(); begin += ProposedRoots::kCapacity) {
    const std::size_t count = std::min(ProposedRoots::kCapacity, entering.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = entering[begin + k];
      roots.add(static_cast<std::size_t>(met_.piece[i]), rays.origin_of(i), rays.direction_of(i), met_.t[i],
                met_.slack[i]);
    }
    points += roots.evaluate(workspace);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = entering[begin + k];
      const auto piece = static_cast<std::uint32_t>(met_.piece[i]);
      const ProposedRoots::Root root = roots.root(k);
      Found& found = found_[i];
      found.evaluations = 2, found.instructions = 2 * pieces_.templates[shared].code.instructions;
      if (!root.confirmed) found.others = all_but_left(rays.leaves[i]);
      if (!root.confirmed || root.t >= rays.length[i]) continue;
      found.piece = piece, found.t = root.t, found.width = root.width;
    }
  }
  return points;
}

void PieceScan::list(std::uint64_t pieces, glm::dvec3 origin, glm::dvec3 direction, double length,
                     PieceBoxes::Visit& visit) const {
  constexpr double kLeastPart = 1e-30, kOutwards = 0x1p-22;  // more than a rounding to float
  glm::dvec3 inverse;
  for (int axis = 0; axis < 3; ++axis) {
    const double part = direction[axis];
    inverse[axis] = 1 / (std::abs(part) < kLeastPart ? std::copysign(kLeastPart, part) : part);
  }
  visit.ahead.clear();
  for (; pieces != 0; pieces &= pieces - 1) {
    const int piece = std::countr_zero(pieces);
    const compiler::Box& box = pieces_.fields[static_cast<std::size_t>(piece)].bound;
    double begin = 0, end = length;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.lo[axis] - origin[axis]) * inverse[axis],
                   b = (box.hi[axis] - origin[axis]) * inverse[axis];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    if (!(begin <= end)) continue;
    const BoxedPiece found{static_cast<float>(begin * (1 - kOutwards)), static_cast<float>(end * (1 + kOutwards)),
                           piece};
    const auto after =
        std::ranges::find_if(visit.ahead, [&](const BoxedPiece& other) { return other.entry <= found.entry; });
    visit.ahead.insert(after, found);
  }
}

}  // namespace fathom::runtime
