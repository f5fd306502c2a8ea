// A rough interface as a crowd of tiny mirrors, its facets: the GGX distribution of their normals, masking and
// shadowing, and sampling of the facets that wo sees.
//
// Local space: the surface's normal is z, and wo lies above. Densities are per solid angle.
// Sources: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; Heitz, "Understanding
// the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 2014.
// Tested by: tests/runtime/material/microfacet_test.cpp
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/base/elementary.h"

namespace fathom::runtime {

class Ggx {
 public:
  Ggx() = default;
  explicit Ggx(float alpha) : alpha_(alpha), alpha2_(alpha * alpha) {}
  float alpha() const { return alpha_; }

  // Returns the density of the facets' normals, per area of the surface: int D cos = 1. Walter's equation 33, with
  // the sine from x and y, because 1 - z^2 has no digits left where alpha is small.
  float d(glm::vec3 m) const {
    const float stretched = (m.x * m.x + m.y * m.y) / alpha2_ + m.z * m.z;
    return 1 / (kPi * alpha2_ * stretched * stretched);
  }
  // Returns the part of the facets seen from a direction with this cosine > 0, by Smith, divided by the cosine, so
  // that the result has a value at the horizon.
  float g1_by_cos(float cos) const { return 2 / (cos + slope(cos)); }
  float g1(float cos) const { return cos * g1_by_cos(cos); }
  // Returns the part of the facets seen from both directions, divided by 4 cos_o cos_i. Facets that lie high are seen
  // from both (Heitz's equation 99, height-correlated).
  float g2_by_4_cos(float cos_o, float cos_i) const { return 0.5f / (cos_i * slope(cos_o) + cos_o * slope(cos_i)); }

  // Returns G2 / G1(wo) of light that a facet sends from cos_o, in [0,1], to cos_i. 0 if cos_i is below the surface.
  float g2_over_g1(float cos_o, float cos_i) const {
    return cos_i > 0 ? 4 * cos_i * g2_by_4_cos(cos_o, cos_i) / g1_by_cos(cos_o) : 0;
  }

  // Samples the normal of a facet that wo sees. Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical
  // Caps", 2023.
  glm::vec3 sample_visible_normal(glm::vec3 wo, glm::vec2 u) const {
    const glm::vec3 view = glm::normalize(glm::vec3(alpha_ * wo.x, alpha_ * wo.y, wo.z));
    const float z = (1 - u.x) * (1 + view.z) - view.z;
    const float radius = std::sqrt(std::fmax(1 - z * z, 0.0f));
    const SinCos angle = sincos_turn(u.y);
    const glm::vec3 half(radius * angle.cos + view.x, radius * angle.sin + view.y, z + view.z);
    return glm::normalize(glm::vec3(alpha_ * half.x, alpha_ * half.y, std::fmax(half.z, 1e-7f)));
  }
  float visible_normal_pdf(glm::vec3 wo, glm::vec3 m) const {
    return g1_by_cos(wo.z) * d(m) * std::fmax(glm::dot(wo, m), 0.0f);
  }
  // Returns the density of wi, the mirror image of wo about a normal sampled by sample_visible_normal().
  float reflection_pdf(glm::vec3 wo, glm::vec3 m) const { return 0.25f * g1_by_cos(wo.z) * d(m); }

 private:
  static constexpr float kPi = 3.14159265358979324f;
  // Returns cos (1 + 2 Lambda(cos)), with Lambda from Heitz's equation 72.
  float slope(float cos) const { return std::sqrt(alpha2_ + (1 - alpha2_) * cos * cos); }

  float alpha_ = 1, alpha2_ = 1;
};

}  // namespace fathom::runtime
