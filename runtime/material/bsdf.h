// How light leaves a surface: how much goes from wi to wo, and which wi to follow.
//
// World space; wo and wi are unit vectors that point away from the surface, the normal is on wo's side.
//
//     const Bsdf bsdf(material_point, normal, wo, eta, inside);
//     const BsdfSample next = bsdf.sample(lobe, u);   // to follow
//     const BsdfValue value = bsdf.evaluate(wi);      // towards a light
//
// Radiance grows by eta^2 where it enters a medium of index eta: f and weight hold that factor as light from wi sees
// it, 1 / eta^2 where wo looks into the medium. It is gone again when the path has left; until then eta_scale keeps
// Russian roulette from judging by it. Diffuse and emissive are Lambert's; specular is a mirror that reflects
// base_color at every angle; transparent is smooth glass with base_color as tint of each crossing; principled is
// principled.h. Only that one has an opacity. Tested by: tests/runtime/material/bsdf_test.cpp
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "runtime/material/fresnel.h"
#include "runtime/material/material.h"
#include "runtime/material/principled.h"
#include "runtime/sampling/warp.h"

namespace fathom::runtime {

struct BsdfSample {
  glm::vec3 wi{0};
  glm::vec3 weight{0};    // f |cos| / pdf; black: absorbed
  float pdf = 0;          // per solid angle, of this wi over all lobes; 0 for a mirror's or a clear pane's
  bool through = false;   // wi is on the other side of the surface
  bool straight = false;  // through as if nothing were there but a tint: a hole by opacity, or a smooth thin wall
  float eta_scale = 1;    // weight * eta_scale is without the scaling of radiance
};

class Bsdf {
 public:
  // eta: refractive index of the space beyond the surface relative to that on wo's side; of what does
  // not fill a body, of its material, from either side. inside: wo lies within the solid.
  Bsdf(const MaterialPoint& m, glm::vec3 normal, glm::vec3 wo, float eta, bool inside);

  BsdfSample sample(float lobe, glm::vec2 u) const;  // three uniform numbers in [0,1)
  BsdfValue evaluate(glm::vec3 wi) const;            // mirrors and clear panes count nothing
  // What of the light from -wo goes straight on to wo: the mean of sample()'s weights where it is straight. A ray
  // towards a light may go on behind the surface and bring so much of it.
  glm::vec3 straight_through() const;
  bool is_delta() const;   // evaluate() is black everywhere
  bool has_lobes() const;  // sample() makes use of `lobe`

 private:
  struct Layers {
    Frame frame;
    Principled principled;
  };
  BsdfSample sample_transparent(float lobe) const;
  BsdfSample sample_layers(float lobe, glm::vec2 u) const;

  MaterialType type_;
  glm::vec3 color_, normal_, wo_;
  float eta_;
  std::optional<Layers> layers_;  // of principled materials only: the others are cheap
};

}  // namespace fathom::runtime
