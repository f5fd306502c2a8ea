// The rays that `fathom chart` marches: camera rays, rays bounced off surfaces, and rays that barely touch surfaces.
// Tested by: tests/runtime/chart/chart_measure_test.cpp
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/field/field.h"
#include "runtime/march/ray.h"

namespace fathom::runtime {

struct RaySet {
  std::string ray_class;
  // Exact in float, so that all methods and the reference are given the same rays.
  std::vector<Ray> rays;
};

// Returns `count` rays of each class. Without surfaces in the camera's view there are only camera rays.
//   camera   through points of the image
//   bounce   from four bands above the camera rays' hits, uniform over the hemisphere
//   grazing  along the tangent planes at the camera rays' hits, above or below by 1e-6 to 1e-2 of the extent,
//            uniform in the logarithm
std::vector<RaySet> make_ray_sets(const compiler::CompiledScene& scene, const Field& field, std::size_t count,
                                  std::uint64_t seed);

// Returns the size of the visible scene, scene units. The field's band is a ten-thousandth of this size.
double extent_of(const Field& field);

}  // namespace fathom::runtime
