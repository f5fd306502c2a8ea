// Nodes whose value matters only by its sign and by being a distance, because no blend or offset measures the value.
// A pass may scale the operands of such a node, or remove operands that change no sign.
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/rewrite.h"

namespace fathom::compiler {

inline bool keeps_signs(Kind kind) {
  return kind == Kind::Union || kind == Kind::Intersection || kind == Kind::Subtraction || kind == Kind::Xor;
}

// [node] True if only the sign of the node's value matters, or if the root does not reach the node.
inline std::vector<bool> only_sign_counts(const Scene& scene) {
  std::vector<bool> free(scene.graph.size(), true);
  const std::vector<bool> reached = reachable(scene);
  for (NodeId id = scene.root + 1; id-- > 0;) {
    if (!reached[id]) continue;
    const Kind kind = scene.graph.kind(id);
    const bool passes_on =
        free[id] && (keeps_signs(kind) || kind == Kind::Transform || kind == Kind::Scaled || kind == Kind::Paint);
    for (const NodeId child : scene.graph.children(id)) free[child] = free[child] && passes_on;
  }
  return free;
}

}  // namespace fathom::compiler
