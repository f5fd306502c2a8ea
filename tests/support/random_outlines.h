// Seeded random outlines, with the extremes that formulas trip over: half turns, touching circles, needles, roundings
// of nothing and of everything. Parameters are exact in float.
#pragma once

#include <vector>

#include "compiler/graph.h"
#include "tests/support/random_scene.h"

namespace fathom::test {

std::vector<double> random_outline_params(compiler::Kind kind, Random& random);

}  // namespace fathom::test
