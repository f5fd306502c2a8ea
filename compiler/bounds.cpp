#include "compiler/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/shapes/node_table.h"
#include "vm/check.h"

namespace fathom::compiler {
namespace {

Knowledge of_primitive(const NodeSpec& row, Params params) {
  Knowledge k;
  k.box = row.bound(params);
  k.outside = row.facts.outside;
  k.inside = row.facts.inside;
  k.symmetric = row.facts.symmetric;
  k.certified = k.outside != Exactness::Estimate;
  if (!k.certified) k.reach = k.reach_max = 0;
  if (row.magnitude) k.magnitude = row.magnitude(params);
  return k;
}

}  // namespace

Knowledge know(const Graph& graph, NodeId id, const std::vector<Knowledge>& known) {
  const NodeSpec& row = spec(graph.kind(id));
  if (row.know == nullptr) return of_primitive(row, graph.params(id));
  // What is known of a number, which is nothing, takes nothing of what it is made of; formulas have thousands.
  if (row.category == Category::Function) return row.know(graph.params(id), {});
  std::vector<Knowledge> children;
  for (const NodeId child : graph.children(id)) children.push_back(known[child]);
  return row.know(graph.params(id), children);
}

std::vector<Knowledge> analyse(const Graph& graph) {
  std::vector<Knowledge> known;
  known.reserve(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) known.push_back(know(graph, id, known));
  return known;
}

Box contents(const Graph& graph, NodeId id, const std::vector<Knowledge>& known) {
  Box result;
  std::vector<bool> wanted(id + 1, false);
  wanted[id] = true;
  for (NodeId node = id + 1; node-- > 0;) {  // parents come after their children
    if (!wanted[node] || known[node].box.empty()) continue;
    if (known[node].box.finite()) {
      result = unite(result, known[node].box);
      continue;
    }
    switch (graph.kind(node)) {
      case Kind::Union:
      case Kind::SmoothUnion:
      case Kind::ChamferUnion:
      case Kind::RoundUnion:
      case Kind::StairsUnion:
      case Kind::Paint:
      case Kind::Scaled:
        for (const NodeId child : graph.children(node)) wanted[child] = true;
        break;
      default:  // a ground alone, or something cut from it
        if (!graph.children(node).empty() && known[graph.children(node)[0]].box.finite()) {
          result = unite(result, known[graph.children(node)[0]].box);
        }
        break;
    }
  }
  return result;
}

std::string_view name(Exactness exactness) {
  switch (exactness) {
    case Exactness::Exact:
      return "exact";
    case Exactness::Bound:
      return "a lower bound";
    default:
      return "an estimate";
  }
}

std::string describe(const Box& box) {
  // Four digits, and more of a side that is far from zero for its length.
  const auto side = [](double lo, double hi) {
    int digits = 4;
    for (double ratio = std::max(std::abs(lo), std::abs(hi)) / (hi - lo); ratio >= 100 && digits < 17; ratio /= 10) {
      ++digits;
    }
    return fmt::format("[{:.{}g},{:.{}g}]", lo, digits, hi, digits);
  };
  if (box.empty()) return "empty";
  return side(box.lo.x, box.hi.x) + "x" + side(box.lo.y, box.hi.y) + "x" + side(box.lo.z, box.hi.z);
}

std::string describe(const Knowledge& k) {
  return fmt::format("bound {}, {} outside, Lipschitz <= {:.4g} ({})", describe(k.box), name(k.outside), k.lipschitz,
                     k.certified ? "proved" : "estimate");
}

}  // namespace fathom::compiler
