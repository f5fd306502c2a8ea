// Area lights that are balls, or cylinders and capsules about the y axis, in their own space. light_shapes.h
// describes their sampling. Tested by: tests/runtime/light/light_shapes_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/shape_sample.h"

namespace fathom::runtime {

ShapeSample sample_ball(glm::dvec3 from, glm::dvec3 centre, double radius, glm::dvec2 u);
double ball_pdf(glm::dvec3 from, glm::dvec3 centre, double radius);

ShapeSample sample_cylinder(const compiler::AreaLight& area_light, glm::dvec3 from, glm::dvec2 u);
double cylinder_pdf(const compiler::AreaLight& area_light, glm::dvec3 from, glm::dvec3 hit);
double cylinder_distance(const compiler::AreaLight& area_light, glm::dvec3 p);  // to the surface

ShapeSample sample_capsule(const compiler::AreaLight& area_light, glm::dvec3 from, glm::dvec2 u);
double capsule_pdf(const compiler::AreaLight& area_light, glm::dvec3 from, glm::dvec3 hit);
double capsule_distance(const compiler::AreaLight& area_light, glm::dvec3 p);  // signed: negative within

}  // namespace fathom::runtime
