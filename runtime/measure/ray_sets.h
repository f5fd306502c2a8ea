// The rays that `fathom chart` follows: what a camera sends, what bounces off surfaces, and what barely touches them.
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
  std::vector<Ray> rays;  // their numbers are exact in float, so that all methods and the truth are given the same
};

// `count` rays each, as far as the camera sees surfaces, of
//   camera   through places of the picture
//   bounce   from four bands above what those hit, evenly over the hemisphere
//   grazing  along the tangent planes of what those hit, above or below by 1e-6 to 1e-2 of the extent, evenly in the
//            logarithm
std::vector<RaySet> make_ray_sets(const compiler::CompiledScene& scene, const Field& field, std::size_t count,
                                  std::uint64_t seed);

// The size of what is looked at, scene units: the field's band is a ten-thousandth of it.
double extent_of(const Field& field);

}  // namespace fathom::runtime
