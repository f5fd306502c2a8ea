// Area lights of every shape, reference points around them, and a chi-square test of the points sampled on them. Each
// light's surface is cut into patches with their own parametrisation, because directions would not separate the parts
// of a small light.
#pragma once

#include <array>
#include <cmath>
#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/light_shapes.h"
#include "tests/support/chi_square.h"

namespace fathom::test {

// Area lights, rotated and translated so that no axis is special.
compiler::AreaLight ball(double radius);
compiler::AreaLight box(glm::dvec3 half);
compiler::AreaLight round(compiler::AreaLight::Shape shape, double radius, double half_height);
compiler::AreaLight quad(double thickness, double skew);

struct NamedAreaLight {
  const char* name;
  compiler::AreaLight area_light;
};
inline const NamedAreaLight kAreaLights[] = {
    {"sphere", ball(0.7)},
    {"tiny sphere", ball(1e-3)},
    {"box", box({0.5, 0.8, 0.3})},
    {"flat box", box({1, 0.01, 0.6})},
    {"small box", box({0.01, 0.02, 0.01})},
    {"cylinder", round(compiler::AreaLight::Shape::Cylinder, 0.5, 0.8)},
    {"disc", round(compiler::AreaLight::Shape::Cylinder, 0.8, 0.005)},
    {"tube", round(compiler::AreaLight::Shape::Cylinder, 0.05, 1)},
    {"capsule", round(compiler::AreaLight::Shape::Capsule, 0.4, 0.6)},
    {"rectangle", quad(0.01, 0)},
    {"quadrilateral", quad(0.01, 0.7)},
};
inline constexpr glm::dvec3 kShadingPoints[] = {{2, 1, 0.5}, {-0.4, 3, 1}, {0.5, -1.5, -0.9}, {10, -7, 4}};

// Chi-square test of `samples` points sampled for the reference point `from`, over 8 x 8 bins per patch. The expected
// counts sum the density over `grid` x `grid` pieces per bin. In a bin that the light's silhouette crosses, the sum
// is only as exact as the pieces are small.
ChiSquare area_light_chi_square(const runtime::AreaLightShape& shape, glm::dvec3 from, int samples, int grid);

}  // namespace fathom::test
