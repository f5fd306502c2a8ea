// A surface in layers: a coat over metal, glass, or pigment under a dielectric boundary. A subset of OpenPBR 1.1
// (Academy Software Foundation, "OpenPBR Surface", 2024), in local space: the normal is z, and wo lies above.
//
//     opacity * [ coat over ( metalness * metal + (1 - metalness) * body ) ]
//     body = transmission * glass + (1 - transmission) * boundary over pigment
//
// Every part is reciprocal: f(wo,wi) = f(wi,wo), through a boundary except for eta^2. No part gives more light than
// it gets:
// - The lost light of a rough boundary comes back as a diffuse lobe, in proportion to the loss of each direction, and
//   for glass on both sides (Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", 2017; energy.h).
// - Pigment gets what the boundary lets through, h = 1 - E: h(wo) h(wi) / average (Kelemen and Szirmay-Kalos, "A
//   Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling", 2001). With diffuse_roughness the
//   divisor moves towards the greatest h, which may lose a few hundredths.
// - Glossy parts under the coat are multiplied by min(t(wo), t(wi)), t = 1 - coat_weight E_coat. That is exact for
//   mirrors.
//
// Differences from OpenPBR: specular_weight changes the index, and so how much light is bent. The coat does not
// change the boundary below it, and its colour does not depend on the angle. There is no fuzz, thin
// film, anisotropy, subsurface or dispersion. From inside, pigment is seen without a boundary, and neither the coat
// nor specular_color takes part in reflection.
// Tested by: tests/runtime/material/bsdf_test.cpp
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/material/energy.h"
#include "runtime/material/fresnel.h"
#include "runtime/material/material.h"
#include "runtime/material/microfacet.h"
#include "runtime/material/oren_nayar.h"

namespace fathom::runtime {

struct BsdfValue {
  glm::vec3 f{0};  // f |cos wi|
  float pdf = 0;   // per solid angle
};

class Principled {
 public:
  // A sampled direction. `weight` is f |cos| / pdf for a mirror or a clear pane. For everything else use evaluate().
  // A direction for which both are black is never sampled.
  struct Draw {
    glm::vec3 wi{0};
    glm::vec3 weight{0};
    bool delta = false;
    bool through = false;
    bool same_medium = false;  // passed a thin wall or a hole, and stays in the medium
  };

  // Parameters as of Bsdf.
  Principled(const MaterialPoint& m, glm::vec3 wo, float eta, bool inside);
  Draw draw(float lobe, glm::vec2 u) const;
  BsdfValue evaluate(glm::vec3 wi) const;
  glm::vec3 straight_through() const;  // part of the light from -wo, through holes and a smooth thin wall
  bool is_delta() const;
  float eta() const { return eta_; }  // by which light is bent

 private:
  enum Lobe { kStraight, kCoat, kMetal, kBoundary, kPigment, kLost, kLostThrough, kLobes };
  // Light that comes back, or passes, diffusely: strength * row(cos_i) * cos_i. The strength depends on wo.
  struct DiffuseLobe {
    glm::vec3 strength{0};
    AlbedoRow row = {};
    glm::vec3 albedo() const { return strength == glm::vec3(0) ? strength : strength * row.average(); }
    glm::vec3 operator()(float cos_i) const { return strength == glm::vec3(0) ? strength : strength * row.at(cos_i); }
  };

  void add_coat(const MaterialPoint& m, float eta);
  void add_metal(const MaterialPoint& m);
  void add_boundary(const MaterialPoint& m);
  void add_pigment(const MaterialPoint& m);
  void add_lost_glass(const MaterialPoint& m);
  void set_chances();

  AlbedoRow under_coat(AlbedoRow row) const;
  AlbedoRow with_coat_loss(AlbedoRow row, float eta) const;
  float coat_passes(float cos) const;
  glm::vec3 boundary_reflects(float fresnel) const;
  glm::vec3 boundary_passes(float passed) const;
  float chance_to_reflect(float fresnel) const;
  Draw draw_boundary(float lobe, glm::vec2 u) const;
  glm::vec3 pass_boundary(glm::vec3 m) const;
  void add_glossy(glm::vec3 wi, BsdfValue& value) const;
  void add_diffuse(glm::vec3 wi, BsdfValue& value) const;
  void add_refracted(glm::vec3 wi, BsdfValue& value) const;
  void add_thin(glm::vec3 wi, BsdfValue& value) const;

  glm::vec3 wo_;
  float eta_, opacity_;
  bool inside_, thin_;
  bool smooth_coat_ = true, smooth_metal_, smooth_boundary_;
  Ggx ggx_, coat_ggx_;
  float coat_weight_ = 0, coat_eta_ = 1;
  AlbedoRow coat_row_;
  float coat_passes_o_ = 1;                        // coat_passes(wo)
  glm::vec3 coat_tint_{1}, coat_tint_through_{1};  // of reflected light, of light that crosses once
  float metal_ = 0;                                // weight of the metal, times specular_weight
  F82Tint metal_tint_;
  glm::vec3 tint_{1};                   // specular_color
  float over_pigment_ = 0, glass_ = 0;  // weights of the boundary over pigment, and of that of glass
  glm::vec3 glass_tint_{1};             // transmission_color
  float boundary_o_ = 0;                // part of wo's light that the boundary over pigment reflects
  glm::vec3 pigment_albedo_{0};         // estimate, for wo
  bool rough_pigment_ = false;
  OrenNayar oren_nayar_;
  DiffuseLobe pigment_, lost_metal_, lost_glass_, lost_through_;
  std::array<float, kLobes> chance_{};  // sums to 1, or all are 0
};

}  // namespace fathom::runtime
