#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

#include "compiler/analysis/lints.h"
#include "compiler/analysis/origin.h"
#include "compiler/analysis/report.h"
#include "compiler/geometry/affine.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

// Ratio of coordinates to thickness at which a float has four bits left for the part.
constexpr double kMost = 0x1p20;
// Maximum number of places checked per node.
constexpr std::size_t kMaxPlaces = 256;
// Maximum number of places of all nodes together, not counting the first place of each node.
constexpr std::size_t kMaxInAll = 1 << 18;

// Computes the places of nodes: [node] the maps from the node's own space to the scene's. A node below a fold, bend
// or repetition has no unique place.
std::vector<std::vector<Affine>> places_of(const FieldGraph& field) {
  const Graph& graph = field.graph();
  std::vector<std::vector<Affine>> places(graph.size());
  places[field.root()] = {kIdentity};
  std::size_t more = kMaxInAll;
  for (NodeId id = field.root() + 1; id-- > 0;) {
    const bool transform = graph.kind(id) == Kind::Transform;
    if (places[id].empty() || (!transform && !takes_own_point(graph, id))) continue;
    const Affine up = transform ? inverse(Affine::from_params(graph.params(id))) : kIdentity;
    for (const NodeId child : field.children(id)) {
      for (const Affine& place : places[id]) {
        if (!places[child].empty() && (places[child].size() == kMaxPlaces || more == 0)) break;
        if (!places[child].empty()) --more;
        places[child].push_back(compose(place, up));
      }
    }
    places[id] = {};  // only places of primitives are read, and primitives have no children
  }
  return places;
}

class PlaceLinter {
 public:
  PlaceLinter(const Scene& scene, glm::dvec3 origin, Diagnostics& diagnostics)
      : field_(scene), origin_(origin), diagnostics_(diagnostics) {
    for (const Diagnostic& said : diagnostics.all()) {
      if (said.code == kTooThin) said_.insert(said.span.begin);
    }
  }

  void run() {
    const std::vector<std::vector<Affine>> places = places_of(field_);
    for (NodeId id = 0; id <= field_.root(); ++id) {
      const Box& box = field_.known(id).box;
      if (spec(field_.graph().kind(id)).category != Category::Primitive || !box.finite()) continue;
      for (const Affine& place : places[id]) check(id, box, place);
    }
  }

 private:
  static constexpr std::string_view kTooThin = "W0506";  // says more than this warning would

  void check(NodeId id, const Box& box, const Affine& place) {
    const Box there = image(place, box);
    const double thick = thickness(field_.graph(), id, box) * singular_values(place).least;
    const double away = std::max(largest_part(there.lo), largest_part(there.hi));
    const Span span = field_.graph().origin(id).span;
    if (thick * kMost >= away || !said_.insert(span.begin).second) return;
    diagnostics_.warning("W0512", span,
                         fmt::format("the {} is too small for where it stands", describe(field_.place(id))),
                         fmt::format("{:.2g} thick, {:.3g} from {},{},{}, about which the programs are made", thick,
                                     away, origin_.x, origin_.y, origin_.z),
                         {"floats are too coarse there, and double, which decides, is slow: make it larger, bring it "
                          "closer to the rest of the scene, or make it a scene of its own"});
  }

  const FieldGraph field_;
  const glm::dvec3 origin_;
  Diagnostics& diagnostics_;
  std::set<std::uint32_t> said_;  // begins of spans with W0506 or W0512
};

}  // namespace

void lint_places(const Scene& scene, glm::dvec3 origin, Diagnostics& diagnostics) {
  PlaceLinter(scene, origin, diagnostics).run();
}

}  // namespace fathom::compiler
