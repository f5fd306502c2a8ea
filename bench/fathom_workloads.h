// Fathom's version of the workloads: the same images at Fathom's own accuracy, on one thread.
#pragma once

#include "bench/workload.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::bench {

// Uses a marcher and find_surfaces() as the integrator does, with shadow rays.
Picture fathom_shadow(const compiler::CompiledScene& scene, const Frame& frame);
// Uses render(): the whole renderer with its materials, auxiliary channels and exact sums.
Picture fathom_paths(const compiler::CompiledScene& scene, const Frame& frame);

}  // namespace fathom::bench
