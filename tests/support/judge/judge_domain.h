// The judge's view of alterations: where the child is asked, and what becomes of the least answer. Formulas of its own,
// in plain doubles; of a repetition it asks far more copies than the machine does.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"

namespace fathom::test {

// Points of the child's space, at least one.
std::vector<glm::dvec3> child_points(compiler::Kind kind, std::span<const double> params, glm::dvec3 p);

// The node's value at p, given the least of the child's values there.
double altered(compiler::Kind kind, std::span<const double> params, glm::dvec3 p, double child);

}  // namespace fathom::test
