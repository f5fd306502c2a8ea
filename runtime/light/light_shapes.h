// Sampling of the shapes of area lights: of the surface that a shading point sees, by solid angle if a closed form is
// known, otherwise by area.
//
//   sphere    the cone around it: Shirley, Wang, Zimmerman, "Monte Carlo Techniques for Direct Lighting
//             Calculations", 1996
//   box       the faces towards the shading point, each nearly by solid angle (box_light_lanes.h)
//   quad      the face on the shading point's side: a rectangle nearly by solid angle, another quad by area. Its
//             rounded edges are not sampled
//   cylinder  the cap and the part of the side that face the shading point, by area
//   capsule   the part of the side by area, its balls like spheres: a point inside the solid is no sample
//
// All numbers are in double and in the programs' coordinates. Tested by: tests/runtime/light/light_shapes_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/box_light_lanes.h"
#include "runtime/light/shape_sample.h"

namespace fathom::runtime {

class AreaLightShape {
 public:
  explicit AreaLightShape(const compiler::AreaLight& area_light);

  // Samples a point of the area light for the shading point `from`. No sample from within the area light.
  ShapeSample sample(glm::dvec3 from, glm::vec2 u) const;
  // Returns the density with which sample() samples `hit`, a point of the surface that `from` sees. 0 if sample()
  // never returns it.
  double pdf(glm::dvec3 from, glm::dvec3 hit) const;
  // Returns the distance from any point to the whole surface, sampled or not.
  double distance(glm::dvec3 place) const;

  glm::dvec3 centre() const { return area_light_.translation; }
  glm::dvec3 normal() const { return area_light_.rotation[2]; }  // of a quad
  double radius() const;                                   // of a ball around the centre that contains the area light
  double area() const;                                     // of the whole surface; for a quad, of one face
  const compiler::AreaLight& area_light() const { return area_light_; }
  // The box to sample, if the light is a box or a rectangle.
  const std::optional<BoxLight>& box() const { return box_; }

 private:
  glm::dvec3 to_local(glm::dvec3 p) const;

  compiler::AreaLight area_light_;
  std::optional<BoxLight> box_;
};

}  // namespace fathom::runtime
