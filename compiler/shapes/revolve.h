// Builds a revolve over an outline that is adapted to the axis (compiler/shapes/revolve.cpp).
// Tested by: tests/compiler/shapes/outlines_test.cpp
#pragma once

#include "compiler/shapes/make_node.h"

namespace fathom::compiler {

// Implements NodeSpec::build. The node's derived number is 1 if the node is as exact as its outline, else 0.
NodeId build_revolve(NodeMaker& maker, Params params, std::span<const NodeId> children, const SourceLocation& origin);

}  // namespace fathom::compiler
