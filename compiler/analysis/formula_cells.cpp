#include "compiler/analysis/formula_cells.h"

#include <algorithm>
#include <span>

#include "compiler/derive/formula_field.h"
#include "compiler/graph/rewrite.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

// True if every node below `root` whose constant is not proved owes this to formulas that have bounds in cells.
bool has_bounds_in_cells(const Graph& graph, NodeId root, const std::vector<NodeFacts>& known) {
  std::vector<bool> reached(root + 1, false);
  reached[root] = true;
  for (NodeId id = root + 1; id-- > 0;) {
    if (!reached[id] || known[id].certified) continue;
    const std::span<const NodeId> children = graph.children(id);
    if (graph.kind(id) == Kind::Bounded) {
      if (proof_of(graph, id) != FormulaProof::InCells) return false;
      continue;
    }
    if (std::ranges::all_of(children, [&](NodeId child) { return known[child].certified; })) return false;
    for (const NodeId child : children) reached[child] = true;
  }
  return true;
}

bool is_steep(const Graph& graph, NodeId id) {
  return graph.kind(id) == Kind::Bounded && proof_of(graph, id) == FormulaProof::Steep;
}

// Returns, per node, whether the node is or contains a formula that is to have bounds in cells.
std::vector<bool> contains_formulas(const Graph& graph, NodeId root, const std::vector<NodeFacts>& known) {
  std::vector<bool> contains(root + 1);
  for (NodeId id = 0; id <= root; ++id) {
    const Kind kind = graph.kind(id);
    if (spec(kind).category == Category::Function) continue;
    // The constant of a formula covers all that is below it.
    contains[id] = !known[id].certified || is_steep(graph, id) ||
                   (kind != Kind::Bounded &&
                    std::ranges::any_of(graph.children(id), [&](NodeId child) { return contains[child]; }));
  }
  return contains;
}

// Returns the root's cancellation without that of steep formulas, whose float error is bounded in cells, too.
double cancellation_of_rest(const Graph& graph, NodeId root) {
  std::vector<NodeFacts> rest;
  for (NodeId id = 0; id <= root; ++id) {
    rest.push_back(derive_facts(graph, id, rest));
    if (is_steep(graph, id)) rest.back().cancellation = 0;
  }
  return rest[root].cancellation;
}

}  // namespace

std::optional<FormulaCells> formula_cells(const Graph& graph, NodeId root, const std::vector<NodeFacts>& known) {
  const std::vector<bool> contains = contains_formulas(graph, root, known);
  if (!contains[root] || !has_bounds_in_cells(graph, root, known)) return std::nullopt;
  if (std::ranges::count(reachable(graph, root), true) > kMaxCellNodes) return std::nullopt;
  FormulaCells cells{{}, 0, cancellation_of_rest(graph, root)};
  std::vector<NodeId> parts = {root};
  while (!parts.empty()) {
    const NodeId id = parts.back();
    parts.pop_back();
    if (!contains[id]) {
      cells.rest_lipschitz = std::max(cells.rest_lipschitz, known[id].lipschitz);
    } else if (graph.kind(id) == Kind::Union || graph.kind(id) == Kind::Paint) {
      for (const NodeId child : graph.children(id)) parts.push_back(child);
    } else if (known[id].box.finite()) {
      cells.box = unite(cells.box, known[id].box);
    } else {
      return std::nullopt;
    }
  }
  return cells;
}

}  // namespace fathom::compiler
