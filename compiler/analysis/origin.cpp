#include "compiler/analysis/origin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>
#include <vector>

#include "compiler/analysis/extent.h"
#include "compiler/geometry/affine.h"
#include "compiler/geometry/direction.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {
namespace {

using glm::dvec3;

// Returns the largest power of two up to `value` > 0.
double power_of_two(double value) {
  int exponent;
  std::frexp(value, &exponent);
  return std::ldexp(1.0, exponent - 1);
}

// Returns the box's centre, rounded, along axes where the centre is far from zero relative to the box's size; 0 along
// other axes.
dvec3 middle_if_far(const Box& box) {
  if (box.empty()) return dvec3(0);
  constexpr double kFar = 8, kLeast = 0x1p-20;
  const dvec3 middle = (box.lo + box.hi) * 0.5;
  // A box with almost no size counts as a millionth of its distance from zero.
  const double size = std::max(glm::length(box.hi - box.lo) / 2, kLeast * largest_part(middle)),
               unit = power_of_two(size);
  dvec3 origin(0);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(middle[i]) > kFar * size) origin[i] = unit * std::round(middle[i] / unit);
  }
  return origin;
}

// Removes whole periods from `move`, which leave an endless repetition as it is. A period of 0 means no repetition.
dvec3 without_periods(dvec3 move, dvec3 period) {
  for (int i = 0; i < 3; ++i) move[i] = period[i] > 0 ? std::remainder(move[i], period[i]) : move[i];
  return move;
}

class Mover {
 public:
  Mover(const Scene& scene, dvec3 origin, std::vector<Surface>& surfaces)
      : scene_(scene), origin_(origin), surfaces_(surfaces), moved_(scene) {}

  // Appends moved nodes behind the others, children first as always.
  Scene run() {
    std::vector<bool> wanted(scene_.root + 1, false);
    wanted[scene_.root] = true;
    for (NodeId id = scene_.root + 1; id-- > 0;) {
      if (!wanted[id] || !moves_children(id)) continue;
      for (const NodeId child : scene_.graph.children(id)) wanted[child] = true;
    }
    twins_.assign(scene_.root + 1, 0);
    for (NodeId id = 0; id <= scene_.root; ++id) {
      if (wanted[id]) twins_[id] = twin(id);
    }
    moved_.root = twins_[scene_.root];
    return std::move(moved_);
  }

 private:
  bool moves_children(NodeId id) const {
    return scene_.graph.kind(id) == Kind::Mirror || takes_own_point(scene_.graph, id);
  }

  // Returns the node of `moved_` whose value at p is the value of node `id` at p + origin.
  NodeId twin(NodeId id) {
    const std::span<const double> old = scene_.graph.params(id);
    std::vector<double> params(old.begin(), old.end());
    switch (scene_.graph.kind(id)) {
      case Kind::Transform: {
        const dvec3 to = Affine::from_params(params)(origin_);
        for (int i = 0; i < 3; ++i) params[static_cast<std::size_t>(4 * i + 3)] = to[i];
        return add(id, params);
      }
      case Kind::Plane:
      case Kind::Mirror:
        params[3] -= glm::dot(direction({params[0], params[1], params[2]}), origin_);
        return add(id, params);
      case Kind::Triangle:
      case Kind::Quad:
        for (std::size_t i = 0; i + 1 < params.size(); ++i) params[i] -= origin_[static_cast<int>(i % 3)];
        return add(id, params);
      case Kind::Paint:
        params[0] = static_cast<double>(shifted(static_cast<std::uint32_t>(params[0])));
        return add(id, params);
      case Kind::InfiniteCylinder:
        return translated(id, {origin_.x, 0, origin_.z});
      case Kind::Gyroid:
      case Kind::SchwarzP:
      case Kind::SchwarzD:
        return translated(id, without_periods(origin_, dvec3(params[0])));
      case Kind::Repetition:
        return translated(id, without_periods(origin_, endless_periods(params)));
      default:
        return moves_children(id) ? add(id, params) : translated(id, origin_);
    }
  }

  // Returns the surface of a Paint that is at p after the move and was at p + origin before.
  std::uint32_t shifted(std::uint32_t surface) {
    if (surface >= surfaces_.size() || !surfaces_[surface].placed) return surface;
    const auto [found, is_new] = shifted_.try_emplace(surface, static_cast<std::uint32_t>(surfaces_.size()));
    if (is_new) {
      surfaces_.push_back(surfaces_[surface]);
      surfaces_.back().shift += origin_;
    }
    return found->second;
  }

  // Returns the periods along the axes on which all copies are equal; 0 along other axes.
  static dvec3 endless_periods(std::span<const double> params) {
    dvec3 period(0);
    const bool jitters = params[6] > 0 || params[7] > 0 || params[8] > 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!jitters && params[3 + i] == 0) period[static_cast<int>(i)] = params[i];
    }
    return period;
  }

  // Adds a copy of the node with `params`.
  NodeId add(NodeId id, std::span<const double> params) {
    const std::span<const NodeId> old = scene_.graph.children(id);
    std::vector<NodeId> children(old.begin(), old.end());
    if (moves_children(id)) {
      for (NodeId& child : children) child = twins_[child];
    }
    return moved_.graph.add(scene_.graph.kind(id), params, children, scene_.graph.origin(id));
  }

  NodeId translated(NodeId id, dvec3 move) {
    if (move == dvec3(0)) return id;
    const std::array<double, 13> params = {1, 0, 0, move.x, 0, 1, 0, move.y, 0, 0, 1, move.z, 1};
    return moved_.graph.add(Kind::Transform, params, std::array<NodeId, 1>{id}, scene_.graph.origin(id));
  }

  const Scene& scene_;
  const dvec3 origin_;
  std::vector<Surface>& surfaces_;
  std::map<std::uint32_t, std::uint32_t> shifted_;
  Scene moved_;
  std::vector<NodeId> twins_;  // [node] its node in moved_
};

// True if the move reduces the points' coordinates by at least as much as it increases the numbers that cancel. A
// steep formula multiplies the rounding error of coordinates that it still has to receive unmoved.
bool pays(const Scene& scene, dvec3 origin, double cancellation) {
  constexpr double kRounding = 1 + 1e-9;
  const Scene there = moved(scene, origin);
  return analyse(there.graph)[there.root].cancellation <= (cancellation + largest_part(origin)) * kRounding;
}

}  // namespace

dvec3 choose_origin(const Scene& scene, const std::vector<NodeFacts>& known, const Camera& camera) {
  const Box part = extent(scene, known);
  const Box view{glm::min(camera.position, camera.target), glm::max(camera.position, camera.target)};
  const dvec3 near_view = part.contains(camera.target) ? middle_if_far(view) : dvec3(0);
  const dvec3 near_parts = middle_if_far(known[scene.root].box.finite() ? part : unite(part, view));
  for (const dvec3 origin : {near_view, near_parts}) {
    if (origin != dvec3(0) && pays(scene, origin, known[scene.root].cancellation)) return origin;
  }
  return dvec3(0);
}

Scene moved(const Scene& scene, dvec3 origin, std::vector<Surface>& surfaces) {
  return Mover(scene, origin, surfaces).run();
}

Scene moved(const Scene& scene, dvec3 origin) {
  std::vector<Surface> none;
  return moved(scene, origin, none);
}

}  // namespace fathom::compiler
