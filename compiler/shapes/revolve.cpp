// The outline that a revolve turns about the y axis. The part of the outline at x >= 0 becomes the solid. An edge on
// the axis becomes no surface, nor does an edge beyond the axis, yet the outline's own distance counts both. The
// compiler therefore rebuilds an outline of straight edges without these edges: the polygon leaves the axis for a
// rectangle half as deep as it is high. From any point at x >= 0, one of the two points where the outline meets the
// axis is at least as near as the rectangle.
#include "compiler/shapes/revolve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "compiler/geometry/affine.h"
#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kRounding = 1e-12;  // of places after transforms, as a share of the largest coordinate
// maximum nodes of an outline that are rebuilt; a shared node counts once per use
constexpr int kMaxNodes = 256;

// Removes the edges of a polygon on the axis and beyond. At least one corner is at x > rounding.
class PolygonTrimmer {
 public:
  explicit PolygonTrimmer(double rounding) : rounding_(rounding) {}

  std::vector<dvec2> trim(const std::vector<dvec2>& corners) {
    const auto kept = [this](dvec2 q) { return q.x > rounding_; };
    const std::size_t n = corners.size();
    const auto first = static_cast<std::size_t>(std::find_if(corners.begin(), corners.end(), kept) - corners.begin());
    dvec2 leaves(0);
    for (std::size_t i = first; i < first + n; ++i) {
      const dvec2 q = corners[i % n], next = corners[(i + 1) % n];
      if (kept(q)) push(q);
      if (kept(q) && !kept(next)) leaves = on_axis(q, next);
      if (!kept(q) && kept(next)) bridge(leaves, on_axis(next, q));
    }
    if (out_.size() > 1 && glm::distance(out_.front(), out_.back()) <= rounding_) out_.pop_back();
    return std::move(out_);
  }

 private:
  dvec2 on_axis(dvec2 kept, dvec2 other) const {
    if (std::abs(other.x) <= rounding_) return {0, other.y};
    return {0, kept.y + kept.x / (kept.x - other.x) * (other.y - kept.y)};
  }

  void bridge(dvec2 from, dvec2 to) {
    const double height = std::abs(to.y - from.y);
    push(from);
    if (height > rounding_) {
      push({-height / 2, from.y});
      push({-height / 2, to.y});
    }
    push(to);
  }

  void push(dvec2 q) {
    if (out_.empty() || glm::distance(out_.back(), q) > rounding_) out_.push_back(q);
  }

  const double rounding_;
  std::vector<dvec2> out_;
};

// Returns the node under a transform with these parameters. Removes a transform at the top of the node if the two
// transforms cancel.
NodeId placed(NodeMaker& maker, NodeId node, Params params, const SourceLocation& origin) {
  const Graph& graph = maker.graph();
  if (graph.kind(node) == Kind::Transform && graph.params(node)[12] * params[12] == 1 &&
      compose(Affine::from_params(graph.params(node)), Affine::from_params(params)) == kIdentity) {
    return graph.children(node)[0];
  }
  return maker.make(Kind::Transform, params, std::array{node}, origin);
}

NodeId moved(NodeMaker& maker, NodeId node, double x, double y, const SourceLocation& origin) {
  if (x == 0 && y == 0) return node;
  const double params[] = {1, 0, 0, -x, 0, 1, 0, -y, 0, 0, 1, 0, 1};
  return placed(maker, node, params, origin);
}

// An outline in the form that revolve turns.
struct Trimmed {
  NodeId node;
  // true if the distance at x >= 0 is that to edges at x > 0 alone, where the outline's distance is exact
  bool exact;
};

class OutlineTrimmer {
 public:
  explicit OutlineTrimmer(NodeMaker& maker) : maker_(maker) {}

  // `place` maps the node's plane to the plane of the revolve, whose y axis is the axis of revolution.
  Trimmed trim(NodeId id, const Affine& place) {
    if (is_clear(id, place)) return {id, true};
    if (++visited_ > kMaxNodes) return {id, false};
    switch (maker_.graph().kind(id)) {
      case Kind::Transform: {
        const Affine up = inverse(Affine::from_params(maker_.graph().params(id)));
        const SingularValues s = singular_values(up);
        if (s.most - s.least > kRounding * s.most) return {id, false};
        return trim_children(id, compose(place, up));
      }
      case Kind::Paint:
      case Kind::Union:
      case Kind::Intersection:
      case Kind::Subtraction:
        return trim_children(id, place);
      default:
        return trim_corners(id, place);
    }
  }

 private:
  // True if all of the node is at x > 0, or the axis is one of its mirror lines.
  bool is_clear(NodeId id, const Affine& place) {
    const NodeFacts& known = maker_.known(id);
    const Box there = image(place, known.box);
    if (there.lo.x > kRounding * std::abs(place.translation.x)) return true;
    const dvec3 row = place.rows[0];
    const bool symmetric = (row.y == 0 && known.symmetric[0]) || (row.x == 0 && known.symmetric[1]);
    return symmetric && place.translation.x == 0;
  }

  Trimmed trim_children(NodeId id, const Affine& place) {
    const Graph& graph = maker_.graph();
    const std::vector<NodeId> children(graph.children(id).begin(), graph.children(id).end());
    std::vector<NodeId> trimmed;
    bool exact = true;
    for (const NodeId child : children) {
      const Trimmed made = trim(child, place);
      trimmed.push_back(made.node);
      exact = exact && made.exact;
    }
    if (trimmed == children) return {id, exact};
    const std::vector<double> params(graph.params(id).begin(), graph.params(id).end());
    const SourceLocation origin = graph.origin(id);
    if (graph.kind(id) == Kind::Transform) return {placed(maker_, trimmed[0], params, origin), exact};
    return {maker_.make(graph.kind(id), params, trimmed, origin), exact};
  }

  Trimmed trim_corners(NodeId id, const Affine& place) {
    const auto corners_of = spec(maker_.graph().kind(id)).corners;
    if (corners_of == nullptr) return {id, false};
    std::vector<dvec2> corners = corners_of(maker_.graph().params(id));
    double largest = std::abs(place.translation.x), min_x = largest, max_x = -largest;
    for (dvec2& q : corners) {
      q = dvec2(place(dvec3(q, 0)));
      largest = std::max({largest, std::abs(q.x), std::abs(q.y)});
      min_x = std::min(min_x, q.x), max_x = std::max(max_x, q.x);
    }
    const double rounding = kRounding * largest;
    if (max_x <= rounding) return {id, false};
    if (min_x > rounding) return {id, true};
    if (maker_.graph().kind(id) == Kind::Rectangle && (place.rows[0].x == 0 || place.rows[0].y == 0)) {
      return {mirrored_rectangle(id, place), true};
    }
    return polygon(id, place, PolygonTrimmer(rounding).trim(corners));
  }

  Trimmed polygon(NodeId id, const Affine& place, const std::vector<dvec2>& corners) {
    if (corners.size() < 3 || corners.size() > kMaxCorners) return {id, false};
    const Affine back = inverse(place);
    std::vector<double> points;
    for (const dvec2 q : corners) {
      const dvec3 p = back(dvec3(q, 0));
      points.insert(points.end(), {p.x, p.y});
    }
    return {maker_.make(Kind::Polygon, points, {}, SourceLocation(maker_.graph().origin(id))), true};
  }

  // Rebuilds a rectangle with sides along and across the axis: the part at x >= 0, and that part's mirror image.
  NodeId mirrored_rectangle(NodeId id, const Affine& place) {
    const std::size_t across = place.rows[0].y == 0 ? 0 : 1;
    const double slope = place.rows[0][static_cast<int>(across)], axis = -place.translation.x / slope;
    std::vector<double> half(maker_.graph().params(id).begin(), maker_.graph().params(id).end());
    half[across] = std::abs((slope > 0 ? half[across] : -half[across]) - axis);
    const SourceLocation origin = maker_.graph().origin(id);
    const NodeId rectangle = maker_.make(Kind::Rectangle, half, {}, origin);
    return across == 0 ? moved(maker_, rectangle, axis, 0, origin) : moved(maker_, rectangle, 0, axis, origin);
  }

  NodeMaker& maker_;
  int visited_ = 0;
};

}  // namespace

NodeId build_revolve(NodeMaker& maker, Params p, std::span<const NodeId> children, const SourceLocation& origin) {
  const NodeId outline = children[0];
  const double offset = p[0];
  const Affine place{kIdentity.rows, dvec3(offset, 0, 0)};
  const Trimmed trimmed = OutlineTrimmer(maker).trim(outline, place);
  const double exact = trimmed.exact ? 1 : 0;
  if (trimmed.node == outline) return maker.make(Kind::Revolve, std::array{offset, exact}, children, origin);
  const NodeId at_axis = moved(maker, trimmed.node, offset, 0, origin);
  return maker.make(Kind::Revolve, std::array{0.0, exact}, std::array{at_axis}, origin);
}

}  // namespace fathom::compiler
