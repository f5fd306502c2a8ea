#include "runtime/mesh/lost/thin_places.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

// Number of times that an edge without a proof is halved, and the most parts of the edges of a batch.
constexpr int kHalvings = 12;
constexpr std::size_t kMostParts = 4096;
// Cells that are searched at once.
constexpr std::size_t kCellsAtOnce = 64;
// The values that corners let expect in a cell: the least difference, as a share of the range at the corners, and
// the share of the expected value below which a surface must be near that the corners do not show.
constexpr double kLeastDifference = 0.03, kNear = 0.5;
// Steps along the gradient, and distances beyond the surface at which the other side is looked for, in cells.
constexpr int kNewtonSteps = 4;
constexpr double kDepths[] = {0x1p-12, 0x1p-10, 0x1p-8, 0x1p-6, 0x1p-4, 0x1p-3, 0x1p-2, 0x1p-1, 1};

// A part of an edge, between two points of which balls without a zero are known.
struct EdgePart {
  std::uint32_t cell;
  glm::dvec3 from, to;
  double from_radius, to_radius;  // scene units
  Side side;                      // of the ends

  double length() const { return glm::distance(from, to); }
  bool is_free() const { return from_radius + to_radius >= length(); }
};

class ThinPlaceSearch {
 public:
  ThinPlaceSearch(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs)
      : probe_(field), steepness_(field.field().step_lipschitz()), lattice_(lattice), signs_(signs) {}

  std::vector<ThinPlace> run(std::uint32_t first, std::uint32_t last) {
    found_.clear();
    parts_.clear();
    for (std::uint32_t cell = first; cell < last; ++cell) search_cell(cell);
    search_edges();
    std::ranges::stable_sort(found_, {}, &ThinPlace::cell);
    return std::move(found_);
  }

 private:
  using Corners = std::array<ProbedPoint, 8>;

  void search_cell(std::uint32_t cell) {
    const LatticePlace place = place_of(signs_.cells()[cell]);
    places_.clear();
    for (unsigned i = 0; i < 8; ++i) places_.push_back(glm::dvec3(lattice_.corner(place.corner(i))));
    probe_.at(places_, points_);
    Corners corners;
    for (std::size_t i = 0; i < 8; ++i) {
      corners[i] = points_[i];
      // The lattice decides, also where float does not.
      corners[i].side = signs_.inside(cell) >> i & 1 ? Side::Inside : Side::Outside;
    }
    add_edges(cell, corners);
    if (is_near_crossed(signs_, cell, 1)) {
      compare_finer(cell, corners);
    } else {
      follow_gradient(cell, 0.5 * (corners[0].place + corners[7].place), corners[0].side);
    }
  }

  // Adds the edges at the cell's lower corner, and the diagonals of its lower faces that join corners of one sign. An
  // edge that may hold a zero has four cells that may, so it is at the lower corner of one of them.
  void add_edges(std::uint32_t cell, const Corners& corners) {
    const auto add = [&](const ProbedPoint& from, const ProbedPoint& to) {
      const EdgePart part{cell, from.place, to.place, from.radius, to.radius, from.side};
      if (from.side == to.side && !part.is_free()) parts_.push_back(part);
    };
    for (unsigned axis = 0; axis < 3; ++axis) add(corners[0], corners[1u << axis]);
    for (int face = 0; face < kCubeFaces; face += 2) {
      if (const auto joined = signs_.joined_corners(cell, face)) add(corners[(*joined)[0]], corners[(*joined)[1]]);
    }
  }

  void search_edges() {
    std::vector<EdgePart> next;
    for (int halving = 0; halving < kHalvings && !parts_.empty() && parts_.size() <= kMostParts; ++halving) {
      places_.clear();
      for (const EdgePart& part : parts_) {
        const double free = 0.5 * (part.from_radius - part.to_radius) / part.length();
        places_.push_back(glm::mix(part.from, part.to, std::clamp(0.5 + free, 0.0, 1.0)));
      }
      probe_.at(places_, points_);
      next.clear();
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        const EdgePart& part = parts_[i];
        const ProbedPoint& middle = points_[i];
        if (middle.side == opposite(part.side)) {
          found_.push_back({part.cell, middle.place, middle.side, true});
          continue;
        }
        EdgePart lower = part, upper = part;
        lower.to = upper.from = middle.place;
        lower.to_radius = upper.from_radius = middle.radius;
        for (const EdgePart& half : {lower, upper}) {
          if (!half.is_free()) next.push_back(half);
        }
      }
      parts_.swap(next);
    }
  }

  // Probes a finer lattice of a cell's points, except in parts without a zero. Returns their shares of the cell.
  std::vector<glm::dvec3> probe_finer(const Corners& corners) {
    const glm::dvec3 lo = corners[0].place, size = corners[7].place - lo;
    std::vector<glm::dvec3> shares, finer;
    for (unsigned i = 0; i < 8; ++i) shares.push_back(0.25 + 0.5 * glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
    probe_all(lo, size, shares);
    const double half = 0.25 * glm::length(size);
    for (unsigned i = 0; i < 8; ++i) {
      if (points_[i].radius >= half) continue;
      for (unsigned k = 0; k < 8; ++k) {
        finer.push_back(shares[i] + 0.25 * (glm::dvec3(k & 1, k >> 1 & 1, k >> 2) - 0.5));
      }
    }
    probe_all(lo, size, finer);
    return finer;
  }

  // Compares the field at points between the corners with the values that the corners let expect, and goes on from
  // the point of each side that differs most.
  void compare_finer(std::uint32_t cell, const Corners& corners) {
    const std::vector<glm::dvec3> shares = probe_finer(corners);
    const auto [least, most] = std::ranges::minmax_element(corners, {}, &ProbedPoint::value);
    const double difference = kLeastDifference * (most->value - least->value);
    struct {
      Side side;
      double excess = 0;
      ProbedPoint point{};
    } worst[] = {{Side::Inside}, {Side::Outside}};
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const double expected = expected_value(corners, shares[i]);
      const double value = expected < 0 ? -points_[i].value : points_[i].value;
      const double excess = kNear * std::abs(expected) - value - difference;
      auto& known = worst[expected < 0 ? 0 : 1];
      if (excess > known.excess) known.excess = excess, known.point = points_[i];
    }
    for (const auto& [side, excess, point] : worst) {
      if (!(excess > 0)) continue;
      if (point.side == opposite(side)) {
        found_.push_back({cell, point.place, point.side, false});
      } else {
        follow_gradient(cell, point.place, side);
      }
    }
  }

  void probe_all(glm::dvec3 lo, glm::dvec3 size, const std::vector<glm::dvec3>& shares) {
    places_.clear();
    for (const glm::dvec3& share : shares) places_.push_back(lo + share * size);
    probe_.at(places_, points_);
  }

  static double expected_value(const Corners& corners, glm::dvec3 share) {
    double sum = 0;
    for (unsigned i = 0; i < 8; ++i) {
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= i >> axis & 1 ? share[axis] : 1 - share[axis];
      sum += weight * corners[i].value;
    }
    return sum;
  }

  // Follows the gradient from a point to the surface, and looks for the other side behind it.
  void follow_gradient(std::uint32_t cell, glm::dvec3 from, Side side) {
    glm::dvec3 at = from, towards(0);
    for (int step = 0; step < kNewtonSteps; ++step) {
      const ProbedPoint point = probe_.at(at);
      towards = probe_.surface_at(at).normal * (side == Side::Inside ? 1.0 : -1.0);
      if (point.side == opposite(side)) break;
      const double way = std::abs(point.value) / steepness_;
      if (!std::isfinite(way)) break;
      at = point.place + way * towards;
      if (glm::distance(at, from) > lattice_.cell) return;
    }
    places_.clear();
    places_.push_back(at);
    for (const double depth : kDepths) places_.push_back(at + depth * lattice_.cell * towards);
    probe_.at(places_, points_);
    for (const ProbedPoint& point : points_) {
      if (point.side != opposite(side)) continue;
      found_.push_back({cell, point.place, point.side, false});
      return;
    }
  }

  FieldProbe probe_;
  const double steepness_;
  const CellLattice& lattice_;
  const SignedLattice& signs_;
  std::vector<glm::dvec3> places_;
  std::vector<ProbedPoint> points_;
  std::vector<EdgePart> parts_;
  std::vector<ThinPlace> found_;
};

}  // namespace

bool is_near_crossed(const SignedLattice& signs, std::uint32_t cell, int reach) {
  const LatticePlace place = place_of(signs.cells()[cell]);
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const LatticePlace near = place.moved(0, x).moved(1, y).moved(2, z);
        if (std::min({near.at[0], near.at[1], near.at[2]}) < 0) continue;
        const std::uint32_t other = signs.cells().find(key_of(near));
        if (other != KeyMap::kNone && signs.is_crossed(other)) return true;
      }
    }
  }
  return false;
}

std::vector<ThinPlace> find_thin_places(const MeshField& field, const CellLattice& lattice,
                                        const SignedLattice& signs, int threads) {
  const std::size_t count = signs.cells().size(), batches = (count + kCellsAtOnce - 1) / kCellsAtOnce;
  std::vector<std::vector<ThinPlace>> found(batches);
  parallel_for(
      threads, batches, [&] { return std::make_unique<ThinPlaceSearch>(field, lattice, signs); },
      [&](std::unique_ptr<ThinPlaceSearch>& search, std::size_t batch) {
        const std::size_t first = batch * kCellsAtOnce, last = std::min(count, first + kCellsAtOnce);
        found[batch] = search->run(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
      });
  std::vector<ThinPlace> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace fathom::runtime
