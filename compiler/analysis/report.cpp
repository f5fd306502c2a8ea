#include "compiler/analysis/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compiler/analysis/formula_cells.h"
#include "compiler/derive/formula_bound.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

// A node's cost below this is only rounding.
constexpr double kCheap = 1 + 1e-6;

bool is_displacement(const Graph& graph, NodeId id) {
  return graph.kind(id) == Kind::Bounded && graph.kind(graph.children(id)[0]) == Kind::Displaced;
}

}  // namespace

std::string describe(const Place& place) {
  return place.name.empty() ? place.type : fmt::format("{} \"{}\"", place.type, place.name);
}

FieldGraph::FieldGraph(const Scene& scene)
    : scene_(normalise(scene)),
      known_(analyse(graph())),
      reached_(graph().size(), false),
      cost_(graph().size(), 1),
      steepness_(graph().size(), 1),
      costliest_(graph().size(), 0) {
  reached_[root()] = true;
  for (NodeId id = root() + 1; id-- > 0;) {
    if (!reached_[id]) continue;
    for (const NodeId child : children(id)) reached_[child] = true;
  }
  for (NodeId id = 0; id <= root(); ++id) {
    if (!reached_[id]) continue;
    double below = 0, steepest = 0;
    costliest_[id] = id;
    for (const NodeId child : children(id)) {
      below = std::max(below, known_[child].lipschitz);
      steepest = std::max(steepest, steepness_[child]);
    }
    const bool levels = graph().kind(id) == Kind::Scaled;
    if (below == 0) below = steepest = 1;
    cost_[id] = levels ? 1 : known_[id].lipschitz / below;
    steepness_[id] = steepest * cost_[id];
    for (const NodeId child : children(id)) {
      if (cost_[costliest_[child]] > cost_[costliest_[id]]) costliest_[id] = costliest_[child];
    }
  }
}

std::vector<NodeId> FieldGraph::children(NodeId id) const {
  const std::span<const NodeId> all = graph().children(id);
  if (graph().kind(id) != Kind::Bounded) return {all.begin(), all.end()};
  if (!is_displacement(graph(), id)) return {};
  return {graph().children(all[0])[0]};
}

bool FieldGraph::has_cells() const { return formula_cells(graph(), root(), known_).has_value(); }

bool FieldGraph::in_cells() const { return !known_[root()].certified && has_cells(); }

bool FieldGraph::estimates(NodeId id) const {
  if (known_[id].certified) return false;
  const std::vector<NodeId> below = children(id);
  return std::all_of(below.begin(), below.end(), [&](NodeId child) { return known_[child].certified; });
}

std::optional<Span> FieldGraph::unbounded_operation(NodeId id) const {
  if (graph().kind(id) != Kind::Bounded) return std::nullopt;
  const std::span<const double> params = graph().params(id);
  const Box box{{params[0], params[1], params[2]}, {params[3], params[4], params[5]}};
  const NodeId field = graph().children(id)[0];
  const NodeId formula = is_displacement(graph(), id) ? graph().children(field)[1] : field;
  const Span span = graph().origin(find_unbounded(graph(), formula, box)).span;
  return span.end > 0 ? std::optional(span) : std::nullopt;
}

Place FieldGraph::place(NodeId id) const {
  Place place{"", graph().origin(id).name, graph().origin(id).span};
  while (graph().kind(id) == Kind::Paint || graph().kind(id) == Kind::Scaled || graph().kind(id) == Kind::Transform) {
    id = graph().children(id)[0];
    if (place.name.empty()) place.name = graph().origin(id).name;
  }
  place.type = spec(graph().kind(id)).name;
  if (graph().kind(id) == Kind::Bounded) place.type = is_displacement(graph(), id) ? "displacement" : "expression";
  return place;
}

std::vector<NodeId> FieldGraph::objects(const std::vector<Surface>& surfaces) const {
  std::set<std::string> names;
  for (const Surface& surface : surfaces) names.insert(surface.name);
  std::vector<NodeId> roots = {scene_.root};
  if (names.size() > 1) roots.assign(graph().children(scene_.root).begin(), graph().children(scene_.root).end());
  for (NodeId& root : roots) {
    while (graph().kind(root) == Kind::Scaled) root = graph().children(root)[0];
  }
  return roots;
}

std::uint32_t FieldGraph::surface(NodeId object) const {
  while (graph().kind(object) != Kind::Paint) {
    const std::vector<NodeId> below = children(object);
    if (below.empty()) return 0;
    object = below[0];
  }
  return static_cast<std::uint32_t>(graph().params(object)[0]);
}

std::string_view class_of(const NodeFacts& facts, bool in_cells) {
  if (!facts.certified || facts.outside == Exactness::Estimate) return in_cells ? "in cells" : "estimate";
  return facts.outside == Exactness::Exact ? "exact" : "bound";
}

Report make_report(const Scene& scene, const std::vector<Surface>& surfaces) {
  const FieldGraph field(scene);
  Report report;
  report.in_cells = field.in_cells();
  report.certified = field.known(field.root()).certified || report.in_cells;
  for (const NodeId object : field.objects(surfaces)) {
    const std::uint32_t surface = field.surface(object);
    ObjectReport& row = report.objects.emplace_back();
    if (surface < surfaces.size()) row.name = surfaces[surface].name;
    row.facts = field.known(object);
    row.lipschitz = field.steepness(object);
    const NodeId worst = field.costliest(object);
    if (field.cost(worst) > kCheap) row.costliest = {field.place(worst), field.cost(worst)};
  }
  for (NodeId id = 0; id <= field.root(); ++id) {
    if (!field.reached(id) || !field.estimates(id)) continue;
    Estimate& estimate = report.estimates.emplace_back(Estimate{field.place(id), std::nullopt});
    if (report.estimates.size() <= Report::kMaxSearched) estimate.operation = field.unbounded_operation(id);
  }
  return report;
}

}  // namespace fathom::compiler
