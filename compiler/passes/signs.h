// Which nodes count by the sign of their value alone, and by its being a distance: not those that a blend or an offset
// measures. Operands of these may be scaled, or left out where they change no sign.
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/rewrite.h"

namespace fathom::compiler {

inline bool keeps_signs(Kind kind) {
  return kind == Kind::Union || kind == Kind::Intersection || kind == Kind::Subtraction || kind == Kind::Xor;
}

// [node]; true for what the root does not reach.
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
