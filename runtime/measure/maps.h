// Chart C: what an image's camera rays cost and how large their errors are, pixel by pixel.
// Tested by: tests/runtime/chart/chart_measure_test.cpp
#pragma once

#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/field/field.h"

namespace fathom::runtime {

// Measurements of the ray through each pixel's centre, [y][x].
struct PixelMaps {
  int width, height;               // pixels
  std::vector<float> evaluations;  // of the field
  std::vector<float> in_double;    // evaluations in double; 0 where float decided
  std::vector<float> depth_error;  // |depth - reference| in units of float's last place; NaN where both miss
};

PixelMaps measure_maps(const compiler::CompiledScene& scene, const Field& field, int width, int height);

}  // namespace fathom::runtime
