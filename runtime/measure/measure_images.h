// The measuring half of chart B: small pictures of a scene by several methods, at several numbers of samples and with
// several seeds, against a reference whose rays were all searched in double. Tested by:
// tests/runtime/chart_measure_test.cpp
#pragma once

#include <span>
#include <vector>

#include "compiler/compiled_scene.h"
#include "runtime/chart/measurements.h"
#include "runtime/method.h"

namespace fathom::runtime {

struct ImagePlan {
  int width = 64, height = 36;  // pixels
  int spp = 64;                 // at most; the curve's other points have a quarter of the next
  int seeds = 16;               // pictures for each point; the reference has seeds of its own
  int reference_spp = 256;
};

// The default, and sphere tracing at several eps.
std::vector<Marching> painted_methods();

// One row for each method and number of samples, seed by seed so that all methods share the machine's moods. A
// picture takes one thread, the reference all.
std::vector<ImageMeasurement> measure_images(const compiler::CompiledScene& scene, std::span<const Marching> methods,
                                             const ImagePlan& plan, const std::string& scene_name);

}  // namespace fathom::runtime
