// The judge's rules for nodes that alter space or distances: the points at which to evaluate the child, and the
// node's value given the child's minimum over them. The formulas are independent of the machine's, in plain double
// arithmetic. For a repetition the judge evaluates more copies than the machine does.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"

namespace fathom::test {

// Returns the points of the child's space at which to evaluate the child; at least one.
std::vector<glm::dvec3> child_points(compiler::Kind kind, std::span<const double> params, glm::dvec3 p);

// Returns the node's value at p, given the minimum of the child's values at child_points().
double altered(compiler::Kind kind, std::span<const double> params, glm::dvec3 p, double child);

}  // namespace fathom::test
