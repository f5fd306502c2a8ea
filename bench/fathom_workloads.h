// The workloads as Fathom does them: the same pictures at its own accuracy, on one thread.
#pragma once

#include "bench/workload.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::bench {

// A marcher and find_surfaces(), as the integrator uses them, with shadow rays.
Picture fathom_shadow(const compiler::CompiledScene& scene, const Frame& frame);
// render(): the whole renderer with its materials, auxiliary channels and exact sums.
Picture fathom_paths(const compiler::CompiledScene& scene, const Frame& frame);

}  // namespace fathom::bench
