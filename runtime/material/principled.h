// A surface in layers: a coat over metal, glass, or a diffuse base under a dielectric interface. A subset of
// OpenPBR 1.1 (Academy Software Foundation, "OpenPBR Surface", 2024), in local space: the normal is z, and wo lies
// above.
//
//     opacity * [ coat over ( metalness * metal + (1 - metalness) * body ) ]
//     body = transmission * glass + (1 - transmission) * interface over diffuse base
//
// Every part is reciprocal: f(wo,wi) = f(wi,wo), through an interface except for eta^2. No part gives more light than
// it gets:
// - The lost light of a rough interface comes back as a diffuse lobe, in proportion to the loss of each direction,
//   and for glass on both sides (Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", 2017;
//   directional_albedo.h).
// - The diffuse base gets what the interface lets through, h = 1 - E: h(wo) h(wi) / average (Kelemen and
//   Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling", 2001). With
//   diffuse_roughness the divisor moves towards the greatest h, which may lose a few hundredths.
// - Glossy parts under the coat are multiplied by min(t(wo), t(wi)), t = 1 - coat_weight E_coat. That is exact for
//   mirrors.
//
// Differences from OpenPBR: specular_weight changes the index, and so how much light is bent. The coat does not
// change the interface below it, and its colour does not depend on the angle. There is no fuzz, thin
// film, anisotropy, subsurface or dispersion. From inside, the diffuse base is seen without an interface, and neither
// the coat nor specular_color takes part in reflection. Tested by: tests/runtime/material/bsdf_test.cpp
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/material/directional_albedo.h"
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
  struct Sample {
    glm::vec3 wi{0};
    glm::vec3 weight{0};
    bool delta = false;
    bool is_transmission = false;
    bool keeps_medium = false;  // passed a thin wall or a hole, and stays in the medium
  };

  // Parameters as of Bsdf.
  Principled(const MaterialPoint& m, glm::vec3 wo, float eta, bool inside);
  Sample sample(float lobe, glm::vec2 u) const;
  BsdfValue evaluate(glm::vec3 wi) const;
  glm::vec3 null_transmission() const;  // part of the light from -wo, through holes and a smooth thin wall
  bool is_delta() const;
  float eta() const { return eta_; }  // by which light is bent

 private:
  enum Lobe {
    kNullTransmission,
    kCoat,
    kMetal,
    kInterface,
    kDiffuse,
    kCompensation,
    kTransmittedCompensation,
    kLobeCount
  };
  // Light that comes back, or passes, diffusely: strength * row(cos_i) * cos_i. The strength depends on wo.
  struct DiffuseLobe {
    glm::vec3 strength{0};
    DirectionalAlbedo row = {};
    glm::vec3 albedo() const { return strength == glm::vec3(0) ? strength : strength * row.average(); }
    glm::vec3 operator()(float cos_i) const { return strength == glm::vec3(0) ? strength : strength * row.at(cos_i); }
  };

  void add_coat(const MaterialPoint& m, float eta);
  void add_metal(const MaterialPoint& m);
  void add_interface(const MaterialPoint& m);
  void add_diffuse_base(const MaterialPoint& m);
  void add_glass_compensation(const MaterialPoint& m);
  void set_lobe_probabilities();

  DirectionalAlbedo attenuate_by_coat(DirectionalAlbedo row) const;
  DirectionalAlbedo add_coat_loss(DirectionalAlbedo row, float eta) const;
  float coat_transmittance(float cos) const;
  glm::vec3 glossy_coat_tint(float cos_m) const;
  glm::vec3 interface_reflectance(float fresnel) const;
  glm::vec3 interface_transmittance(float passed) const;
  float reflection_probability(float fresnel) const;
  Sample sample_interface(float lobe, glm::vec2 u) const;
  glm::vec3 transmitted_direction(glm::vec3 m) const;
  void add_glossy(glm::vec3 wi, BsdfValue& value) const;
  void add_diffuse(glm::vec3 wi, BsdfValue& value) const;
  void add_refracted(glm::vec3 wi, BsdfValue& value) const;
  void add_thin(glm::vec3 wi, BsdfValue& value) const;

  glm::vec3 wo_;
  float eta_, opacity_;
  bool inside_, thin_;
  bool smooth_coat_ = true, smooth_metal_, smooth_interface_;
  Ggx ggx_, coat_ggx_;
  float coat_weight_ = 0, coat_eta_ = 1;
  DirectionalAlbedo coat_albedo_;
  float coat_transmittance_o_ = 1;                     // coat_transmittance(wo)
  glm::vec3 coat_tint_{1}, transmitted_coat_tint_{1};  // of diffusely reflected light, of light that crosses once
  glm::vec3 coat_color_{1};                            // of light that crosses twice, not darkened
  float coat_darkens_ = 0, inner_diffuse_ = 0;         // part of diffuse light that the coat's inner side reflects
  float inner_roughness_ = 1;
  glm::vec3 body_albedo_{0};  // part of the base's albedo that is no metal's
  float metal_ = 0;           // weight of the metal, times specular_weight
  F82Tint metal_tint_;
  glm::vec3 tint_{1};                   // specular_color
  float over_diffuse_ = 0, glass_ = 0;  // weights of the interface over diffuse base, and of that of glass
  glm::vec3 glass_tint_{1};             // transmission_color
  float interface_reflectance_o_ = 0;   // part of wo's light that the interface over diffuse base reflects
  glm::vec3 diffuse_albedo_{0};         // estimate, for wo
  bool rough_diffuse_ = false;
  OrenNayar oren_nayar_;
  DiffuseLobe diffuse_base_, metal_compensation_, glass_compensation_, transmitted_compensation_;
  std::array<float, kLobeCount> lobe_probability_{};  // sums to 1, or all are 0
};

}  // namespace fathom::runtime
