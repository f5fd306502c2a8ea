// Lamps as shapes that points are chosen on: the surface that a place sees, by solid angle where that is known in
// closed form, else by area.
//
//   sphere    the cone around it: Shirley, Wang, Zimmerman, "Monte Carlo Techniques for Direct Lighting
//             Calculations", 1996
//   box       the faces that face the place, each nearly by solid angle (seen_rectangle.h)
//   quad      the face on the place's side: likewise when it is a rectangle, else by area. Its rounded edges are not
//             sampled
//   cylinder  the cap and the part of the side that face the place, by area
//   capsule   the side likewise, its balls as spheres: what is chosen within the solid is no sample
//
// Everything is in double and in the programs' coordinates. Tested by: tests/runtime/light/light_shapes_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/shape_sample.h"

namespace fathom::runtime {

class LampShape {
 public:
  explicit LampShape(const compiler::Lamp& lamp);

  // A point of the lamp for the place `from`; none from within the lamp.
  ShapeSample sample(glm::dvec3 from, glm::vec2 u) const;
  // The density with which sample() chooses `hit`, a point of the surface that `from` sees; 0 where it never does.
  double pdf(glm::dvec3 from, glm::dvec3 hit) const;
  // From any place to the nearest of the whole surface, sampled or not.
  double distance(glm::dvec3 place) const;

  glm::dvec3 centre() const { return lamp_.translation; }
  glm::dvec3 normal() const { return lamp_.rotation[2]; }  // of a quad
  double radius() const;                                   // of a ball around the centre that holds the lamp
  double area() const;                                     // of the whole surface; of a quad, of one face
  const compiler::Lamp& lamp() const { return lamp_; }

 private:
  glm::dvec3 to_local(glm::dvec3 p) const;

  compiler::Lamp lamp_;
  bool rectangle_ = false;  // a quad that is one
};

}  // namespace fathom::runtime
