// Fold over a checked node from the leaves up, with an explicit stack because files may nest nodes to any depth.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace fathom::compiler {

// Returns leave(root, down, results of its children). For each node `down` is enter(node, its parent's down), the
// value that the node passes on to its children. `Node` is CheckedNode, const or not.
template <class Result, class Node, class Down, class Enter, class Leave>
Result fold_nodes(Node& root, Down above, Enter enter, Leave leave) {
  struct Open {
    Node* node;
    Down down;
    std::size_t first;     // index of the first result of a child
    std::size_t next = 0;  // index of the next child
  };
  std::vector<Result> results;
  std::vector<Open> open = {{&root, enter(root, above), 0}};
  for (;;) {
    Open& top = open.back();
    if (top.next < top.node->children.size()) {
      Node& child = top.node->children[top.next++];
      open.push_back({&child, enter(child, top.down), results.size()});
      continue;
    }
    Result result = leave(*top.node, top.down, std::span<const Result>(results).subspan(top.first));
    if (open.size() == 1) return result;
    results.resize(top.first);
    results.push_back(std::move(result));
    open.pop_back();
  }
}

}  // namespace fathom::compiler
