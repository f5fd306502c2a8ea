#include "compiler/shapes/make_node.h"

namespace fathom::compiler {

NodeId NodeMaker::make(Kind kind, Params params, std::span<const NodeId> children, const SourceLocation& origin) {
  const NodeSpec& row = spec(kind);
  // A row's own `build` calls make() again over other children, with the derived numbers after the parameters.
  const bool is_built = row.code && params.size() > row.params.size();
  if (row.build && !is_built) return row.build(*this, params, children, origin);
  if (row.expand) return row.expand(graph_, params, origin);
  if (!row.derive) return graph_.add(kind, params, children, origin);
  return graph_.add(kind, row.with_derived(params, known_of(children)), children, origin);
}

ErrorText NodeMaker::complaint(Kind kind, Params params, std::span<const NodeId> children) {
  const NodeSpec& row = spec(kind);
  return row.check_children ? row.check_children(params, known_of(children)) : std::nullopt;
}

const NodeFacts& NodeMaker::known(NodeId id) {
  while (known_.size() <= id) known_.push_back(derive_facts(graph_, static_cast<NodeId>(known_.size()), known_));
  return known_[id];
}

std::vector<NodeFacts> NodeMaker::known_of(std::span<const NodeId> children) {
  std::vector<NodeFacts> result;
  for (const NodeId child : children) result.push_back(known(child));
  return result;
}

}  // namespace fathom::compiler
