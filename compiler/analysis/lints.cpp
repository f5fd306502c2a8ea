#include "compiler/analysis/lints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <set>
#include <utility>

#include "compiler/analysis/report.h"
#include "compiler/derive/formula_field.h"
#include "compiler/geometry/affine.h"
#include "compiler/passes/containment.h"
#include "compiler/passes/signs.h"
#include "compiler/shapes/blends.h"
#include "compiler/shapes/node_table.h"
#include "compiler/shapes/print_graph.h"
#include "vm/interpret/evaluate.h"

namespace fathom::compiler {
namespace {

// Factor of step shortening from which the compiler warns.
constexpr double kSteep = 20;

// True for alterations that only move, rotate, repeat or name their child: empty stays empty, thin stays thin.
bool rearranges(Kind kind) {
  switch (kind) {
    case Kind::Paint:
    case Kind::Scaled:
    case Kind::Transform:
    case Kind::Mirror:
    case Kind::Repetition:
    case Kind::PolarRepetition:
    case Kind::Twist:
      return true;
    default:
      return false;
  }
}

// Returns the box's smallest side greater than 0. An outline has no extent along z.
double min_extent(const Box& box) {
  double least = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const double extent = box.hi[i] - box.lo[i];
    if (extent > 0) least = std::min(least, extent);
  }
  return least;
}

double greatest_extent(const Box& box) {
  const glm::dvec3 size = box.hi - box.lo;
  return std::max({size.x, size.y, size.z});
}

glm::dvec3 nearest_point(const Box& box, glm::dvec3 p) { return glm::min(glm::max(p, box.lo), box.hi); }

class Linter {
 public:
  Linter(const Scene& scene, const SceneTables& tables, Diagnostics& diagnostics)
      : field_(scene), scene_(field_.scene()), graph_(field_.graph()), tables_(tables), diagnostics_(diagnostics) {}

  void run(const vm::VerifiedProgram& surface) {
    find_vanishing();
    find_light();
    find_hidden();
    for (NodeId id = 0; id <= scene_.root; ++id) {
      if (!field_.reached(id)) continue;
      check_repetition(id);
      check_blend(id);
      check_area_light(id);
      check_steepness(id);
    }
    check_thinness();
    check_camera(surface);
  }

 private:
  Kind kind(NodeId id) const { return graph_.kind(id); }
  const Box& box(NodeId id) const { return field_.known(id).box; }

  std::string word(NodeId id) const { return describe(field_.place(id)); }

  // Warns once per place in the file: a named node that is used often gives equal nodes in one place.
  void warn(const char* code, NodeId at, std::string message, std::string label, std::string help) {
    const Span span = graph_.origin(at).span;
    if (!warned_.insert({code, span.begin}).second) return;
    diagnostics_.warning(code, span, std::move(message), std::move(label), {std::move(help)});
  }

  // Finds nodes without any solid: intersections of disjoint operands, cuts that leave nothing, nodes made of such
  // nodes. Also warns of cuts that cut nothing.
  void find_vanishing() {
    vanishes_.assign(graph_.size(), false);
    for (NodeId id = 0; id <= scene_.root; ++id) {
      if (!field_.reached(id)) continue;
      const std::vector<NodeId> children = field_.children(id);
      const auto gone = [&](NodeId child) { return bool(vanishes_[child]); };
      switch (is_blend(kind(id)) ? hard(kind(id)) : kind(id)) {
        case Kind::Union:
          vanishes_[id] = std::all_of(children.begin(), children.end(), gone);
          break;
        case Kind::Intersection:
          vanishes_[id] = std::any_of(children.begin(), children.end(), gone) || check_meeting(id, children);
          break;
        case Kind::Subtraction:
          vanishes_[id] = gone(children[0]) || check_cuts(id, children);
          break;
        case Kind::Revolve:
          vanishes_[id] = gone(children[0]) || check_beyond_axis(id);
          break;
        default:
          vanishes_[id] = (rearranges(kind(id)) || kind(id) == Kind::Taper || kind(id) == Kind::Bend ||
                           kind(id) == Kind::Extrude) &&
                          gone(children[0]);
          break;
      }
    }
  }

  bool check_meeting(NodeId id, const std::vector<NodeId>& operands) {
    Box common = Box::everything();
    for (const NodeId operand : operands) common = intersect(common, box(operand));
    if (operands.size() < 2 || !(common.empty() || containment_.avoids(graph_, id, common))) return false;
    warn("W0502", id, "this intersection holds nothing", "its operands never meet",
         "move them together, or leave the node out; what is in any of them is a \"union\"");
    return true;
  }

  bool check_beyond_axis(NodeId id) {
    const double farthest = box(graph_.children(id)[0]).hi.x + graph_.params(id)[0];
    if (farthest > 0) return false;
    warn("W0502", id, "this revolve holds nothing",
         fmt::format("its outline ends at x = {:.4g}, and only what is at x > 0 turns", farthest),
         "move the outline to the other side of the y axis by `translate` or `offset`");
    return true;
  }

  bool check_cuts(NodeId id, const std::vector<NodeId>& operands) {
    for (std::size_t i = 1; i < operands.size(); ++i) {
      const NodeId cut = operands[i];
      if (containment_.holds(graph_, cut, box(operands[0]))) {
        warn("W0502", id, "this subtraction leaves nothing", fmt::format("the {} takes all of it", word(cut)),
             "make the cut smaller, or leave the node out; the first node is the one that is cut");
        return true;
      }
      // A smooth subtraction removes more than the cut.
      if (vanishes_[operands[0]] || is_blend(kind(id)) || !containment_.avoids(graph_, cut, box(operands[0])))
        continue;
      warn("W0503", cut, fmt::format("the {} cuts nothing off", word(cut)), "it does not touch what it is taken from",
           "move it there, or leave it out; a cut has the place of the subtraction, not of the scene");
    }
    return false;
  }

  void find_hidden() {
    const std::vector<bool> free = only_sign_counts(scene_);
    for (NodeId id = 0; id <= scene_.root; ++id) {
      if (!field_.reached(id) || !free[id] || kind(id) != Kind::Union) continue;
      const std::span<const NodeId> arms = graph_.children(id);
      if (arms.size() > Containment::kLongestList) continue;
      for (const auto [arm, within] : containment_.hidden_arms(graph_, arms)) {
        if (holds_clear_[within]) continue;
        if (is_area_light_[arm]) {
          warn("W0507", arm, fmt::format("the area light {} emits no light", word(arm)),
               fmt::format("it is wholly inside the {}", word(within)),
               "move it out, or cut room for it out of what it is in");
        } else {
          warn("W0501", arm, fmt::format("the {} never shows", word(arm)),
               fmt::format("it is wholly inside the {}", word(within)),
               "a union has no inside walls: leave it out, move it, or cut room for it out of what it is in");
        }
      }
    }
  }

  bool is_clear(std::size_t surface) const {
    return transmits(tables_.materials[tables_.surfaces[surface].material]);
  }

  void find_light() {
    holds_clear_.resize(graph_.size()), is_area_light_.resize(graph_.size());
    for (NodeId id = 0; id <= scene_.root; ++id) {
      const std::span<const NodeId> children = graph_.children(id);
      const auto surface = kind(id) == Kind::Paint ? static_cast<std::size_t>(graph_.params(id)[0]) : 0;
      holds_clear_[id] =
          (kind(id) == Kind::Paint && surface < tables_.surfaces.size() && is_clear(surface)) ||
          std::any_of(children.begin(), children.end(), [&](NodeId child) { return holds_clear_[child]; });
      const bool joins = kind(id) == Kind::Scaled || kind(id) == Kind::Transform || kind(id) == Kind::Union;
      is_area_light_[id] = kind(id) == Kind::Paint
                               ? emits(id)
                               : joins && std::all_of(children.begin(), children.end(),
                                                      [&](NodeId child) { return is_area_light_[child]; });
    }
  }

  bool emits(NodeId paint) const {
    const auto number = static_cast<std::size_t>(graph_.params(paint)[0]);
    if (number >= tables_.surfaces.size()) return false;
    return compiler::emits(tables_.materials[tables_.surfaces[number].material]);
  }
  void check_area_light(NodeId id) {
    if (kind(id) != Kind::Paint || !emits(id)) return;
    const glm::dvec3 size = box(id).hi - box(id).lo;
    const int flat = (size.x <= 0) + (size.y <= 0) + (size.z <= 0);
    if (!vanishes_[id] && flat < 2) return;
    warn("W0507", id, fmt::format("the area light {} emits no light", word(id)), "it has no surface",
         "only surfaces emit light: give it one");
  }

  void check_repetition(NodeId id) {
    if (kind(id) != Kind::Repetition && kind(id) != Kind::PolarRepetition) return;
    const std::span<const double> params = graph_.params(id);
    const std::size_t copies = spec(kind(id)).code(params).points.size();
    const Box& child = box(graph_.children(id)[0]);
    bool overlaps = false;
    if (kind(id) == Kind::Repetition) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<int>(i);
        const double reach = std::max(child.hi[axis], -child.lo[axis]) + params[6 + i];
        overlaps = overlaps || (params[i] > 0 && 2 * reach > params[i] * (1 + 1e-9));
      }
    } else {
      overlaps = copies > 2;
    }
    if (!overlaps || copies < 2) return;
    warn("W0504", id,
         fmt::format("{} copies of the {} are evaluated at every point", copies, word(graph_.children(id)[0])),
         "the node reaches across its cell",
         kind(id) == Kind::Repetition
             ? "keep the node, and its jitter, within half a \"period\" of the origin, or make the period larger"
             : "make the node narrower as seen from the axis, move it further out, or make fewer copies");
  }

  // A blend of width k moves the surface by up to k/4, a cut edge by up to k/2. A move beyond half a part's thickness
  // leaves nothing of its shape. A union only adds, and only near the other part: a long thin part keeps its shape.
  void check_blend(NodeId id) {
    if (!is_blend(kind(id))) return;
    const double width = graph_.params(id)[0];
    const double moved = kind(id) <= Kind::SmoothSubtraction ? width / 4 : width / 2;
    const bool adds = hard(kind(id)) == Kind::Union;
    for (const NodeId operand : graph_.children(id)) {
      const double extent = adds ? greatest_extent(box(operand)) : min_extent(box(operand));
      if (moved <= extent / 2) continue;
      const std::string_view name = spec(kind(id)).params[0].name;
      warn("W0505", id, fmt::format("the blend is too wide for the {}", word(operand)),
           fmt::format("`{}` of {:.4g} moves the surface by up to {:.4g}, and that is {:.4g} {}", name, width, moved,
                       extent, adds ? "long" : "thick"),
           fmt::format("with `{}` up to {:.4g} the part keeps its shape", name, width * extent / 2 / moved));
      return;
    }
  }

  void check_steepness(NodeId id) {
    if (field_.steepness(id) < kSteep) return;
    for (const NodeId child : field_.children(id)) {
      if (field_.steepness(child) >= kSteep) return;
    }
    const NodeId worst = field_.costliest(id);
    std::string help = "turn, bend or displace less, or make what is turned narrower";
    if (kind(worst) == Kind::Bounded) help = "give the formula a smaller slope, or a smaller box";
    if (kind(worst) == Kind::Taper) help = "taper less: steps shrink with the smallest scale";
    if (kind(worst) == Kind::Twist)
      help = "turn less, or make what is turned narrower: its radius times the turn counts";
    const bool in_cells =
        kind(worst) == Kind::Bounded && proof_of(graph_, worst) != FormulaProof::Proved && field_.has_cells();
    const std::string below = worst == id ? "" : fmt::format(", most of it by the {} below", word(worst));
    warn("W0508", id,
         fmt::format("this {} makes steps {:.3g} times shorter{}", word(id), field_.steepness(id), below),
         in_cells ? "rays take that many times longer where it is steepest" : "rays take that many times longer here",
         help);
  }

  // True if a thin child makes the node as thin.
  static bool keeps_thinness(Kind kind) {
    switch (kind) {
      case Kind::Union:
      case Kind::Intersection:
      case Kind::Subtraction:
      case Kind::Xor:
      case Kind::Bend:
        return true;
      default:
        return rearranges(kind);
    }
  }

  // Warns of nodes thinner than 16 times the float error at their distance from the camera or the origin. The nearest
  // and the largest use of a node count.
  void check_thinness() {
    constexpr double kErrors = 16;
    std::vector<double> scale(graph_.size(), 0), away(graph_.size(), kInfinity);  // [node]
    for (const NodeId object : field_.objects(tables_.surfaces)) {
      const glm::dvec3 p = nearest_point(box(object), tables_.camera.position);
      const double size = std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      scale[object] = 1;
      away[object] = std::min(away[object], std::max(size, glm::length(p - tables_.camera.position)));
    }
    for (NodeId id = scene_.root + 1; id-- > 0;) {
      if (!field_.reached(id) || scale[id] == 0) continue;
      const double thin = thickness(graph_, id, box(id)) * scale[id],
                   resolution = kErrors * vm::kFloatError * away[id];
      if (thin < resolution) {
        warn("W0506", id, fmt::format("the {} is thinner than floats tell apart", word(id)),
             fmt::format("{:.2g} thick, {:.3g} from the camera or the origin, where {:.2g} is the least to rely on",
                         thin, away[id], resolution),
             away[id] > 1
                 ? "make it thicker, or bring camera and scene closer to the origin"
                 : "make it thicker, or the whole scene larger: errors shrink no further below a distance of 1");
      }
      if (!keeps_thinness(kind(id))) continue;
      double factor = scale[id];
      if (kind(id) == Kind::Transform) factor /= singular_values(Affine::from_params(graph_.params(id))).least;
      for (const NodeId child : field_.children(id)) {
        scale[child] = std::max(scale[child], factor);
        away[child] = std::min(away[child], away[id]);
      }
    }
  }

  void check_camera(const vm::VerifiedProgram& surface) {
    if (tables_.camera.projection == Camera::Projection::Orthographic) return;
    vm::Workspace workspace;
    const vm::SurfaceValue value = vm::evaluate_surface(surface, tables_.camera.position, workspace);
    if (!(value.distance < 0)) return;
    if (value.surface < tables_.surfaces.size() && is_clear(value.surface)) return;
    NodeId at = scene_.root;
    for (const NodeId object : field_.objects(tables_.surfaces)) {
      if (value.surface < tables_.surfaces.size() && field_.surface(object) < tables_.surfaces.size() &&
          tables_.surfaces[field_.surface(object)].name == tables_.surfaces[value.surface].name) {
        at = object;
      }
    }
    warn("W0510", at, fmt::format("the camera is inside the {}", word(at)),
         fmt::format("{:.3g} below its surface", -value.distance),
         "move the camera's `position` out, or cut room for it");
  }

  const FieldGraph field_;
  const Scene& scene_;
  const Graph& graph_;
  const SceneTables& tables_;
  Diagnostics& diagnostics_;
  Containment containment_;
  std::vector<bool> vanishes_;     // [node]
  std::vector<bool> holds_clear_;  // [node] true if light passes some of it, so that its contents show
  std::vector<bool> is_area_light_;  // [node] true if it consists of area lights alone, by the outermost Paint
  std::set<std::pair<std::string, std::uint32_t>> warned_;
};

}  // namespace

void lint(const Scene& scene, const SceneTables& tables, const vm::VerifiedProgram& surface,
          Diagnostics& diagnostics) {
  Linter(scene, tables, diagnostics).run(surface);
}

double thickness(const Graph& graph, NodeId id, const Box& box) {
  const Kind kind = graph.kind(id);
  double least = spec(kind).category == Category::Primitive ? min_extent(box) : kInfinity;
  for (const NamedParam& param : named_params(kind, graph.params(id))) {
    if (param.name == "thickness" || param.name == "half_depth") least = std::min(least, 2 * param.values[0]);
  }
  return least;
}

}  // namespace fathom::compiler
