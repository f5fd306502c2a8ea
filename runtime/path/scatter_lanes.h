// The parts of the stage of scattering that run in lanes.
// Tested by: tests/runtime/path/scatter_lanes_test.cpp
#pragma once

#include "runtime/path/vertex_batch.h"

namespace fathom::runtime {

// Samples wi, its weight and its pdf at every vertex as Bsdf::sample() does for a diffuse material, from `u`, `v`,
// `normal` and `albedo`.
void sample_diffuse(VertexBatch& batch);

}  // namespace fathom::runtime
