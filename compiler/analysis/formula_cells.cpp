#include "compiler/analysis/formula_cells.h"

#include <algorithm>
#include <span>

#include "compiler/derive/formula_field.h"
#include "compiler/graph/rewrite.h"

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

}  // namespace

std::optional<FormulaCells> formula_cells(const Graph& graph, NodeId root, const std::vector<NodeFacts>& known) {
  if (known[root].certified || !has_bounds_in_cells(graph, root, known)) return std::nullopt;
  if (std::ranges::count(reachable(graph, root), true) > kMaxCellNodes) return std::nullopt;
  FormulaCells cells{{}, 0};
  std::vector<NodeId> parts = {root};
  while (!parts.empty()) {
    const NodeId id = parts.back();
    parts.pop_back();
    if (known[id].certified) {
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
