// The scattering of light at a surface: the BSDF's value for a pair of directions, and sampling of directions to
// follow.
//
// World space. wo and wi are unit vectors that point away from the surface, and the normal is on wo's side.
//
//     const Bsdf bsdf(material_point, normal, wo, eta, inside);
//     const BsdfSample next = bsdf.sample(lobe, u);   // to follow
//     const BsdfValue value = bsdf.evaluate(wi);      // towards a light
//
// Radiance grows by eta^2 where it enters a medium of index eta. f and weight contain that factor as light from wi
// sees it: 1 / eta^2 where wo looks into the medium. The factor cancels when the path has left the medium. Until then
// eta_scale keeps Russian roulette from judging by the factor. Diffuse and emissive are Lambertian. Specular is a
// mirror that reflects base_color at every angle. Transparent is smooth glass with base_color as tint per crossing.
// Principled (principled.h) alone has an opacity. Tested by: tests/runtime/material/bsdf_test.cpp
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
  glm::vec3 weight{0};   // f |cos| / pdf; black: absorbed
  float pdf = 0;         // of wi over all lobes, per solid angle; 0 for a mirror or a clear pane
  bool is_transmission = false;  // wi is on the other side of the surface
  // Passed through unbent, with no more than a tint: through a hole by opacity, or a smooth thin wall.
  bool is_null = false;
  float eta_scale = 1;  // weight * eta_scale is free of the scaling of radiance
};

class Bsdf {
 public:
  // eta: refractive index of the space beyond the surface relative to that on wo's side. If the material does not
  // fill a body: the material's own index, from either side. inside: wo lies within the solid.
  Bsdf(const MaterialPoint& m, glm::vec3 normal, glm::vec3 wo, float eta, bool inside);

  BsdfSample sample(float lobe, glm::vec2 u) const;  // three uniform numbers in [0,1)
  BsdfValue evaluate(glm::vec3 wi) const;            // without mirrors and clear panes
  // Returns the part of the light from -wo that continues straight to wo: the mean of sample()'s weights, counted
  // only if is_null. A ray towards a light may continue behind the surface and bring this part of the light.
  glm::vec3 null_transmission() const;
  bool is_delta() const;   // true if evaluate() is black everywhere
  bool has_lobes() const;  // true if sample() uses `lobe`

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
  std::optional<Layers> layers_;  // only of principled materials, the others are cheap
};

}  // namespace fathom::runtime
