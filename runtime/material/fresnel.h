// The reflectance of an interface, and the directions of reflected and refracted light.
//
// Directions are unit vectors away from the surface, and the normal is on wo's side. `eta` is the index of refraction
// of the far side relative to wo's side.
// Tested by: tests/runtime/material/bsdf_test.cpp
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fathom::runtime {

inline glm::vec3 reflect_about(glm::vec3 wo, glm::vec3 normal) {
  return glm::normalize(2 * glm::dot(wo, normal) * normal - wo);
}

// Returns the refracted direction by Snell's law. Requires fresnel() < 1.
inline glm::vec3 refract_through(glm::vec3 wo, glm::vec3 normal, float eta) {
  const float cos_i = glm::dot(wo, normal);
  const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  const float cos_t = std::sqrt(sin2_t < 1 ? 1 - sin2_t : 0.0f);
  return glm::normalize((cos_i / eta - cos_t) * normal - wo / eta);
}

// Returns the reflectance of a dielectric for unpolarised light that arrives at the cosine `cos_i` and is refracted
// to the cosine `cos_t`, both in [0,1].
// Source: Fresnel's equations, as in Born and Wolf, "Principles of Optics", 7th ed. 1999, section 1.5.2.
inline float fresnel_reflectance(float cos_i, float cos_t, float eta) {
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// Returns 1 - fresnel_reflectance(), with full precision where almost no light passes.
inline float fresnel_transmittance(float cos_i, float cos_t, float eta) {
  const float parallel = eta * cos_i + cos_t, perpendicular = cos_i + eta * cos_t;
  return 2 * eta * cos_i * cos_t * (1 / (parallel * parallel) + 1 / (perpendicular * perpendicular));
}

// Returns fresnel_reflectance() when only the cosine in [0,1] on the side of the incident light is known. 1 if no
// light passes (total internal reflection).
inline float fresnel(float cos_i, float eta) {
  const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  if (sin2_t >= 1) return 1;
  return fresnel_reflectance(cos_i, std::sqrt(1 - sin2_t), eta);
}

// Returns the reflectance of a pane, with all reflections between its two sides: R + T^2 R + T^2 R^3 + ...
// = 2 R / (1 + R).
inline float slab_reflectance(float one_side) { return 2 * one_side / (1 + one_side); }

// Reflectance of a metal, given its colour at normal incidence and the tint of that colour at about 82 degrees, where
// the cosine is 1/7: Schlick's curve minus a term that is 0 at both ends.
// Source: Kutz, Hasan, Edmondson, "Novel aspects of the Adobe Standard Material", 2021; OpenPBR 1.1, "Metal".
class F82Tint {
 public:
  F82Tint() = default;
  F82Tint(glm::vec3 normal, glm::vec3 tint_at_82) : normal_(normal) {
    constexpr float kCos = 1.0f / 7;
    dip_ = schlick(kCos) * (1.0f - tint_at_82) / (kCos * sixth(1 - kCos));
  }
  glm::vec3 operator()(float cos) const {
    return glm::clamp(schlick(cos) - dip_ * (cos * sixth(1 - cos)), 0.0f, 1.0f);
  }
  // Returns the average over the hemisphere by cosine: 2 int F mu dmu = F0 + (1 - F0) / 21 - dip / 126.
  glm::vec3 average() const { return glm::clamp(normal_ + (1.0f - normal_) / 21.0f - dip_ / 126.0f, 0.0f, 1.0f); }

 private:
  static float sixth(float x) { return x * x * x * x * x * x; }
  glm::vec3 schlick(float cos) const {
    const float x = 1 - cos;
    return normal_ + (1.0f - normal_) * (x * x * x * x * x);
  }
  glm::vec3 normal_{0}, dip_{0};
};

}  // namespace fathom::runtime
