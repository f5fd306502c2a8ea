#include "compiler/shapes/bounds.h"

#include "compiler/shapes/node_table.h"
#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

NodeFacts of_primitive(const NodeSpec& row, Params params) {
  NodeFacts k;
  k.box = row.bound(params);
  k.outside = row.facts.outside;
  k.inside = row.facts.inside;
  k.symmetric = row.facts.symmetric;
  k.certified = k.outside != Exactness::Estimate;
  if (!k.certified) k.reach = k.reach_max = 0;
  if (row.cancellation) k.cancellation = row.cancellation(params);
  return k;
}

bool reads_point(const Instruction& instruction) {
  const vm::Form form = vm::info(instruction.opcode).form;
  return form == vm::Form::Point || form == vm::Form::Shape || form == vm::Form::Outline;
}

}  // namespace

NodeFacts derive_facts(const Graph& graph, NodeId id, const std::vector<NodeFacts>& known) {
  const NodeSpec& row = spec(graph.kind(id));
  if (row.derive_facts == nullptr) return of_primitive(row, graph.params(id));
  // Number nodes have no facts, so their children's facts are not gathered: formulas have thousands of nodes.
  if (row.category == Category::Function) return row.derive_facts(graph.params(id), {});
  std::vector<NodeFacts> children;
  for (const NodeId child : graph.children(id)) children.push_back(known[child]);
  return row.derive_facts(graph.params(id), children);
}

std::vector<NodeFacts> analyse(const Graph& graph) {
  std::vector<NodeFacts> known;
  known.reserve(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) known.push_back(derive_facts(graph, id, known));
  return known;
}

Box contents(const Graph& graph, NodeId id, const std::vector<NodeFacts>& known) {
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
      default:  // an unbounded node, e.g. a ground alone: only a bounded first child counts
        if (!graph.children(node).empty() && known[graph.children(node)[0]].box.finite()) {
          result = unite(result, known[graph.children(node)[0]].box);
        }
        break;
    }
  }
  return result;
}

bool takes_own_point(const Graph& graph, NodeId id) {
  if (graph.children(id).empty()) return false;
  const Code code = spec(graph.kind(id)).code(graph.params(id));
  return code.points.size() == 1 && code.points[0].empty() &&
         std::none_of(code.after.begin(), code.after.end(), reads_point);
}

}  // namespace fathom::compiler
