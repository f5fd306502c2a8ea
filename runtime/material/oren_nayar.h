// Diffuse reflection of a rough surface: Lambertian facets, and the light that travels on between them, so that a
// white surface stays white.
// Source: Portsmouth, Kutz, Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT 2025.
// Tested by: tests/runtime/material/bsdf_test.cpp
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fathom::runtime {

class OrenNayar {
 public:
  // `color`: albedo of a facet, components in [0,1]. `roughness`: in [0,1], Lambertian at 0.
  OrenNayar() = default;
  OrenNayar(glm::vec3 color, float roughness)
      : color_(color), roughness_(roughness), share_(1 / (1 + kFirst * roughness)) {
    const float average = share_ * (1 + kSecond * roughness);
    const glm::vec3 multiple = color * color * average / (1.0f - color * (1 - average));
    multiple_scattering_ = average < 1 ? multiple / (1 - average) : glm::vec3(0);
  }

  // Returns pi f. Local space: the normal is z, and both directions lie above the surface.
  glm::vec3 operator()(glm::vec3 wo, glm::vec3 wi) const {
    const float s = glm::dot(wo, wi) - wo.z * wi.z;
    const float single = share_ * (1 + roughness_ * (s > 0 ? s / std::max(wo.z, wi.z) : s));
    return color_ * single + multiple_scattering_ * ((1 - albedo(wo.z)) * (1 - albedo(wi.z)));
  }

 private:
  // Returns the albedo of white facets for light that met only one facet, by the paper's fit (its equation for
  // G / pi).
  float albedo(float cos) const {
    const float c = 1 - cos;
    const float g = c * (0.0571085289f + c * (0.491881867f + c * (-0.332181442f + c * 0.0714429953f)));
    return std::min(share_ * (1 + roughness_ * g), 1.0f);
  }
  static constexpr float kPi = 3.14159265358979324f;
  static constexpr float kFirst = 0.5f - 2 / (3 * kPi), kSecond = 2.0f / 3 - 28 / (15 * kPi);

  glm::vec3 color_{0}, multiple_scattering_{0};
  float roughness_ = 0, share_ = 1;
};

}  // namespace fathom::runtime
