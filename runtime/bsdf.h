// How light leaves a surface: wo, normal, material, random numbers -> wi and the weight of the path.
//
// wo and wi are unit vectors that point away from the surface; the normal is on wo's side. `weight` is
// f |cos| / pdf, the factor for the path's throughput; every choice is sampled exactly, so it is a colour.
// Tested by: tests/runtime/bsdf_test.cpp
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "runtime/material.h"
#include "runtime/sampler.h"
#include "runtime/warp.h"

namespace fathom::runtime {

struct BsdfSample {
  glm::vec3 wi{0};
  glm::vec3 weight{0};   // black: the path ends here
  bool through = false;  // wi is on the other side of the surface
};

inline glm::vec3 reflect_about(glm::vec3 wo, glm::vec3 normal) {
  return glm::normalize(2 * glm::dot(wo, normal) * normal - wo);
}

// Reflectance of a dielectric for unpolarised light. `cos_i` in [0,1] is on the side the light comes from, `eta` the
// index of the far side relative to it. 1 when nothing passes (total internal reflection).
// Source: Fresnel's equations, as in Born and Wolf, "Principles of Optics", 7th ed. 1999, section 1.5.2.
inline float fresnel(float cos_i, float eta) {
  const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  if (sin2_t >= 1) return 1;
  const float cos_t = std::sqrt(1 - sin2_t);
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// The refracted direction by Snell's law; only where fresnel() < 1.
inline glm::vec3 refract_through(glm::vec3 wo, glm::vec3 normal, float eta) {
  const float cos_i = glm::dot(wo, normal);
  const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  const float cos_t = std::sqrt(sin2_t < 1 ? 1 - sin2_t : 0.0f);
  return glm::normalize((cos_i / eta - cos_t) * normal - wo / eta);
}

// Lambert's: density cos/pi, so that the weight is the albedo.
inline BsdfSample sample_diffuse(glm::vec3 color, glm::vec3 normal, Sampler& sampler) {
  const glm::vec3 local = square_to_cosine_hemisphere(sampler.next2());
  return {to_frame(normal, local), color, false};
}

// A smooth dielectric: reflects with the probability that Fresnel's equations give, else refracts. `inside`: wo lies
// within the solid. The scaling of radiance by eta^2 at a crossing is left out: light is seen where it leaves the
// glass again, and there the two cancel.
inline BsdfSample sample_transparent(const Material& m, glm::vec3 wo, glm::vec3 normal, bool inside,
                                     Sampler& sampler) {
  const float eta = inside ? 1 / m.ior : m.ior;
  const float cos_i = std::fmin(glm::dot(wo, normal), 1.0f);
  if (sampler.next() < fresnel(cos_i, eta)) return {reflect_about(wo, normal), glm::vec3(1), false};
  return {refract_through(wo, normal, eta), m.color, true};
}

inline BsdfSample sample_bsdf(const Material& m, glm::vec3 wo, glm::vec3 normal, bool inside, Sampler& sampler) {
  switch (m.type) {
    case Material::Type::Diffuse:
    case Material::Type::Emissive:
    case Material::Type::Principled:
      return sample_diffuse(m.color, normal, sampler);
    case Material::Type::Specular:
      return {reflect_about(wo, normal), m.color, false};
    case Material::Type::Transparent:
      return sample_transparent(m, wo, normal, inside, sampler);
  }
  return {};
}

}  // namespace fathom::runtime
