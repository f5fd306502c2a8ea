#include "compiler/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/affine.h"

namespace fathom::compiler {
namespace {

constexpr double kSqrt3 = 1.7320508075688772;

// The largest coordinate in the box; infinite when it has no end.
double largest_coordinate(const Box& box) {
  if (box.empty()) return 0;
  double largest = 0;
  for (int i = 0; i < 3; ++i) largest = std::max({largest, std::abs(box.lo[i]), std::abs(box.hi[i])});
  return largest;
}

// The surface moved out by `by`.
Knowledge offset(Knowledge k, double by) {
  if (by <= 0) return k;
  k.magnitude += by;
  if (!(k.reach_max > 0)) {
    k.box = Box::everything();
    return k;
  }
  k.box = k.box.grown(by / k.reach_max);
  if (k.reach < k.reach_max) k.reach = std::min(k.reach, k.reach_max / kSqrt3);
  return k;
}

Knowledge of_primitive(const NodeSpec& row, std::span<const double> params) {
  Knowledge k;
  k.box = row.bound(params);
  k.outside = row.outside;
  k.inside = row.inside;
  k.certified = row.outside != Exactness::Estimate;
  if (!k.certified) k.reach = k.reach_max = 0;
  if (row.kind == Kind::Triangle || row.kind == Kind::Quad) {
    // They are evaluated from their first corner: at most that far off, or their own size.
    const double first_corner = std::max({std::abs(params[0]), std::abs(params[1]), std::abs(params[2])});
    k.magnitude = std::min(first_corner, glm::length(k.box.hi - k.box.lo));
  }
  return k;
}

Knowledge of_transform(std::span<const double> params, const Knowledge& child) {
  const Affine to_child = Affine::from_params(params);
  const double factor = params[12];
  const Stretch s = stretch(to_child);
  Knowledge k = child;
  k.box = image(inverse(to_child), child.box);
  // In the child's space a point lies as far off as the translation adds, but near the surface within the child's
  // box.
  const glm::dvec3 t = glm::abs(to_child.translation);
  k.magnitude = factor * (std::min(std::max({t.x, t.y, t.z}), largest_coordinate(child.box)) + child.magnitude);
  // A product that is 1 but for rounding is 1: the factor is the smallest scale, the most stretch its inverse.
  const double slope = factor * s.most;
  k.lipschitz = child.lipschitz * (std::abs(slope - 1) < 1e-12 ? 1 : slope);
  const double reach = std::min(1.0, factor * s.least * (1 + 1e-15));
  k.reach = child.reach * reach;
  k.reach_max = std::max(k.reach, child.reach_max * reach / (is_axis_aligned(to_child) ? 1 : kSqrt3));
  if (s.most - s.least > 1e-12 * s.most) {
    k.outside = std::max(k.outside, Exactness::Bound);
    k.inside = std::max(k.inside, Exactness::Bound);
  }
  return k;
}

// Lipschitz constants, certificates and reach of several children together; boxes and exactness are the caller's.
Knowledge together(std::span<const NodeId> children, const std::vector<Knowledge>& known) {
  Knowledge k = known[children[0]];
  for (NodeId child : children) {
    const Knowledge& c = known[child];
    k.lipschitz = std::max(k.lipschitz, c.lipschitz);
    k.certified = k.certified && c.certified;
    k.reach = std::min(k.reach, c.reach);
    k.reach_max = std::min(k.reach_max, c.reach_max);
    k.outside = std::max(k.outside, c.outside);
    k.inside = std::max(k.inside, c.inside);
    k.magnitude = std::max(k.magnitude, c.magnitude);
  }
  return k;
}

Knowledge of_union(std::span<const NodeId> children, const std::vector<Knowledge>& known) {
  Knowledge k = together(children, known);
  for (NodeId child : children) k.box = unite(k.box, known[child].box);
  if (children.size() > 1) k.inside = std::max(k.inside, Exactness::Bound);
  return k;
}

Knowledge of_intersection(std::span<const NodeId> children, const std::vector<Knowledge>& known) {
  Knowledge k = together(children, known);
  for (NodeId child : children) k.box = intersect(k.box, known[child].box);
  // Apart, they leave nothing; but an offset of this field may, so keep a box its distance is measured from.
  if (k.box.empty()) k.box = known[children[0]].box;
  k.outside = std::max(k.outside, Exactness::Bound);
  k.inside = std::max(k.inside, Exactness::Bound);
  k.reach /= kSqrt3;  // an intersection's corner is up to sqrt 3 further than its faces
  return k;
}

Knowledge of_subtraction(std::span<const NodeId> children, const std::vector<Knowledge>& known) {
  Knowledge k = together(children, known);
  const Knowledge& base = known[children[0]];  // only cuts away: the base's box and reach hold
  k.box = base.box;
  k.reach = base.reach;
  k.reach_max = base.reach_max;
  k.outside = std::max(k.outside, Exactness::Bound);
  k.inside = std::max(k.inside, Exactness::Bound);
  return k;
}

// Of width `width`: the operands' distances count up to there.
Knowledge blended(Knowledge k, double width) {
  k.magnitude += width;
  k.outside = std::max(k.outside, Exactness::Bound);
  k.inside = std::max(k.inside, Exactness::Bound);
  return k;
}

Knowledge of_node(const Graph& graph, NodeId id, const std::vector<Knowledge>& known) {
  const Kind kind = graph.kind(id);
  const auto params = graph.params(id);
  const auto children = graph.children(id);
  switch (kind) {
    case Kind::Round: {
      Knowledge k = offset(known[children[0]], params[0]);
      k.inside = std::max(k.inside, Exactness::Bound);
      return k;
    }
    case Kind::Onion: {
      Knowledge k = offset(known[children[0]], params[0]);
      k.outside = std::max(k.outside, known[children[0]].inside);
      k.inside = std::max(k.inside, Exactness::Bound);
      return k;
    }
    case Kind::Transform:
      return of_transform(params, known[children[0]]);
    case Kind::Paint:
      return known[children[0]];
    case Kind::Union:
      return of_union(children, known);
    case Kind::SmoothUnion:
      // One blend lowers the distance by at most k/4; many by at most k, for an operand k away changes nothing.
      return blended(offset(of_union(children, known),
                            std::min(1.0, 0.25 * static_cast<double>(children.size() - 1)) * params[0]),
                     params[0]);
    case Kind::Intersection:
      return of_intersection(children, known);
    case Kind::SmoothIntersection:
      return blended(of_intersection(children, known), params[0]);
    case Kind::Subtraction:
      return of_subtraction(children, known);
    case Kind::SmoothSubtraction:
      return blended(of_subtraction(children, known), params[0]);
    default:
      return of_primitive(spec(kind), params);
  }
}

std::string_view name(Exactness e) {
  switch (e) {
    case Exactness::Exact:
      return "exact";
    case Exactness::Bound:
      return "a lower bound";
    default:
      return "an estimate";
  }
}

}  // namespace

std::vector<Knowledge> analyse(const Graph& graph) {
  std::vector<Knowledge> known;
  known.reserve(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) known.push_back(of_node(graph, id, known));
  return known;
}

std::string describe(const Knowledge& k) {
  const auto side = [](double lo, double hi) { return fmt::format("[{:.4g},{:.4g}]", lo, hi); };
  const std::string box = k.box.empty() ? "empty"
                                        : side(k.box.lo.x, k.box.hi.x) + "x" + side(k.box.lo.y, k.box.hi.y) + "x" +
                                              side(k.box.lo.z, k.box.hi.z);
  return fmt::format("bound {}, {} outside, Lipschitz <= {:.4g} ({})", box, name(k.outside), k.lipschitz,
                     k.certified ? "proved" : "estimate");
}

}  // namespace fathom::compiler
