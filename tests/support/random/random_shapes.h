// Seeded random primitives, with the extremes at which formulas fail: tips of cones, fat and thin rings, half turns,
// touching circles, needles, roundings of zero and of the whole size. Parameters are exact in float.
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/shapes/node_spec.h"
#include "tests/support/random/random_scene.h"

namespace fathom::test {

// Returns parameters that the rules of the row allow, of size about 1, drawn until they fit together. For kinds whose
// formulas fail at no extremes.
std::vector<double> plain_params(const compiler::NodeSpec& row, Random& random);

std::vector<double> random_solid_params(compiler::Kind kind, Random& random);
std::vector<double> random_outline_params(compiler::Kind kind, Random& random);

inline double rounded(double x) { return static_cast<double>(static_cast<float>(x)); }

}  // namespace fathom::test
