#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/analysis/lints.h"
#include "compiler/analysis/report.h"
#include "compiler/geometry/affine.h"
#include "compiler/shapes/blends.h"
#include "compiler/shapes/print_graph.h"

namespace fathom::compiler {
namespace {

constexpr NodeId kNone = std::numeric_limits<NodeId>::max();

// Factors by which a node's value near its surface is less than the distance: at most `most`, on average over the
// surface `mean`.
struct Shortfall {
  double most, mean;
};

// Ratios of the gradient's bound, sqrt 3, to its minimum and to its mean length on the surface.
std::optional<Shortfall> shortfall_of_periodic(Kind kind) {
  switch (kind) {
    case Kind::Gyroid:
      return Shortfall{1.2247, 1.13};
    case Kind::SchwarzP:
      return Shortfall{std::numbers::sqrt3, 1.32};
    case Kind::SchwarzD:
      return Shortfall{1.2247, 1.16};
    default:
      return std::nullopt;
  }
}

class OffsetLinter {
 public:
  OffsetLinter(const Scene& scene, Diagnostics& diagnostics) : field_(scene), diagnostics_(diagnostics) {}

  void run() {
    std::vector<NodeId> short_of(field_.graph().size(), kNone);  // [node] the node within that falls short
    for (NodeId id = 0; id <= field_.root(); ++id) {
      if (!field_.reached(id)) continue;
      if (falls_short(id)) short_of[id] = id;
      for (const NodeId child : field_.children(id)) {
        if (short_of[id] == kNone) short_of[id] = short_of[child];
      }
      if (short_of[id] == kNone || !measures(id)) continue;
      warn(id, short_of[id]);
      short_of[id] = kNone;  // reported once
    }
  }

 private:
  Kind kind(NodeId id) const { return field_.graph().kind(id); }
  SingularValues operator_norm(NodeId id) const {
    return singular_values(Affine::from_params(field_.graph().params(id)));
  }

  bool falls_short(NodeId id) const {
    if (kind(id) != Kind::Transform) return shortfall_of_periodic(kind(id)).has_value();
    const SingularValues s = operator_norm(id);
    return s.most - s.least > 1e-9 * s.most;
  }

  bool measures(NodeId id) const {
    return (kind(id) == Kind::Round || kind(id) == Kind::Onion || is_blend(kind(id))) &&
           field_.graph().params(id)[0] > kMinBlend;
  }

  // True if the transform keeps the axes at right angles, as a scale does and a shear does not.
  bool keeps_angles(NodeId id) const {
    const Affine map = Affine::from_params(field_.graph().params(id));
    const Affine back = inverse(map);
    const auto column = [&](int i) { return glm::dvec3(back.rows[0][i], back.rows[1][i], back.rows[2][i]); };
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 a = column(i), b = column((i + 1) % 3);
      if (std::abs(glm::dot(a, b)) > 1e-9 * glm::length(a) * glm::length(b)) return false;
    }
    return true;
  }

  void warn(NodeId id, NodeId part) {
    const std::optional<Shortfall> periodic = shortfall_of_periodic(kind(part));
    if (periodic) return warn_of_periodic(id, part, *periodic);
    const SingularValues s = operator_norm(part);
    const double times = s.most / s.least;
    if (kind(field_.graph().children(part)[0]) == Kind::Sphere) return warn_of_ellipsoid(id, times);
    const bool scaled = keeps_angles(part);
    report(id, times, "",
           scaled ? "a part of it is scaled by different amounts, which keeps no distances"
                  : "a part of it is sheared, which keeps no distances",
           fmt::format("{}, or {} this node instead, which {}s the offset too",
                       scaled ? "give the shape its size by its own parameters" : "draw the shape oblique itself",
                       scaled ? "scale" : "shear", scaled ? "scale" : "shear"));
  }

  void warn_of_ellipsoid(NodeId id, double times) {
    std::string help = "make the `radii` larger in place of it";
    if (kind(id) == Kind::Onion) help = "for an even wall take an ellipsoid with smaller `radii` out of a larger one";
    if (is_blend(kind(id))) help = narrower(id, times);
    report(id, times, "", "the distance of an ellipsoid in it is a lower bound, most of all beside its long ends",
           help);
  }

  void warn_of_periodic(NodeId id, NodeId part, const Shortfall& shortfall) {
    const std::string name = describe(field_.place(part));
    std::string help = fmt::format("divided by {:.3g} is right on the average over the surface", shortfall.mean);
    if (kind(id) == Kind::Onion) help = "a `thickness` " + help;
    if (kind(id) == Kind::Round) help = "a `radius` " + help;
    if (is_blend(kind(id))) help = narrower(id, shortfall.most);
    report(id, shortfall.most, ", and more where that is not small beside the `period`",
           fmt::format("the value of the {} is less than the distance, by a factor that differs from place to place",
                       name),
           help);
  }

  std::string narrower(NodeId id, double times) const {
    const std::string_view name = named_params(kind(id), field_.graph().params(id))[0].name;
    return fmt::format("with `{}` up to {:.4g} it moves the surface nowhere further than it says now", name,
                       field_.graph().params(id)[0] / times);
  }

  void report(NodeId id, double times, const std::string& more, std::string label, std::string help) {
    const Span span = field_.graph().origin(id).span;
    if (!warned_.insert(span.begin).second) return;
    diagnostics_.warning("W0511", span,
                         fmt::format("the {} moves the surface up to {:.3g} times as far as it says{}",
                                     describe(field_.place(id)), times, more),
                         std::move(label), {std::move(help)});
  }

  const FieldGraph field_;
  Diagnostics& diagnostics_;
  std::set<std::uint32_t> warned_;  // begins of spans with this warning
};

}  // namespace

void lint_offsets(const Scene& scene, Diagnostics& diagnostics) { OffsetLinter(scene, diagnostics).run(); }

}  // namespace fathom::compiler
