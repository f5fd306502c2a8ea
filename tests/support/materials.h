// Materials for the tests of the BSDF, and the directions from which the tests look at them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "runtime/material/bsdf.h"
#include "runtime/sampling/sampler.h"

namespace fathom::test {

using runtime::Bsdf, runtime::MaterialPoint, runtime::MaterialType;

inline const glm::vec3 kNormal = glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f));
inline constexpr float kCosines[] = {1, 0.8f, 0.5f, 0.2f, 0.05f};

// Returns a direction on the normal's side; `turn` is the azimuth in turns.
inline glm::vec3 towards(float cos, float turn) {
  const float sin = std::sqrt(1 - cos * cos);
  return runtime::to_frame(kNormal,
                           {sin * runtime::sincos_turn(turn).cos, sin * runtime::sincos_turn(turn).sin, cos});
}

// Material, seen from one of its sides.
struct MaterialCase {
  std::string name;
  MaterialPoint material;
  bool inside = false;

  // Relative index of refraction as the BSDF takes it. A material without an interior has the same index from both
  // sides.
  float eta() const { return inside && material.has_interior() ? 1 / material.ior : material.ior; }
  // Like eta(), but as seen from wi's side; `through` is true if wi lies on the other side of the surface.
  float across(bool through) const { return through && material.has_interior() ? 1 / eta() : eta(); }
  Bsdf bsdf(glm::vec3 wo) const { return {material, kNormal, wo, eta(), inside}; }
  // Effective index of refraction of the specular boundary, scaled by specular_weight.
  float bending() const {
    if (material.thin_walled || material.type != MaterialType::Principled) return 1;
    const float s = std::sqrt(material.specular_weight) * (eta() - 1) / (eta() + 1);
    return (1 + s) / (1 - s);
  }
};

inline MaterialPoint principled(float roughness) {
  MaterialPoint m;
  m.type = MaterialType::Principled;
  m.base_color = glm::vec3(1);
  m.roughness = roughness;
  return m;
}
inline MaterialPoint metal(float alpha) {
  MaterialPoint m = principled(std::sqrt(alpha));
  m.metalness = 1;
  return m;
}
inline MaterialPoint glass(float alpha, bool thin = false) {
  MaterialPoint m = principled(std::sqrt(alpha));
  m.transmission = 1;
  m.thin_walled = thin;
  return m;
}
inline MaterialPoint coated(float coat_roughness) {
  MaterialPoint m = principled(0.5f);
  m.coat_weight = 1;
  m.coat_roughness = coat_roughness;
  return m;
}
inline MaterialPoint matte(float diffuse_roughness) {
  MaterialPoint m = principled(0.3f);
  m.diffuse_roughness = diffuse_roughness;
  m.specular_weight = 0;
  return m;
}
inline MaterialPoint mix() {
  MaterialPoint m = principled(0.6f);
  m.base_color = {0.9f, 0.5f, 0.2f};
  m.diffuse_roughness = 0.5f;
  m.metalness = 0.3f;
  m.specular_weight = 0.8f;
  m.specular_color = {1, 0.8f, 0.7f};
  m.transmission = 0.4f;
  m.transmission_color = {0.5f, 0.9f, 0.8f};
  m.coat_weight = 0.6f;
  m.coat_roughness = 0.4f;
  m.coat_color = {0.8f, 0.9f, 1};
  m.coat_darkening = 0.7f;
  m.opacity = 0.8f;
  return m;
}

inline std::vector<MaterialCase> materials() {
  std::vector<MaterialCase> cases;
  cases.push_back({"diffuse", {}});
  cases.push_back({"rough diffuse", matte(1)});
  for (float alpha : {0.02f, 0.1f, 0.5f, 1.0f}) cases.push_back({"metal " + std::to_string(alpha), metal(alpha)});
  for (float alpha : {0.1f, 0.5f}) {
    cases.push_back({"glass " + std::to_string(alpha), glass(alpha)});
    cases.push_back({"glass from inside " + std::to_string(alpha), glass(alpha), true});
  }
  cases.push_back({"plastic", principled(0.5f)});
  cases.push_back({"varnish", coated(0)});
  cases.push_back({"rough coat", coated(0.5f)});
  cases.push_back({"thin wall", glass(0.2f, true)});
  cases.push_back({"mix", mix()});
  cases.push_back({"mix from inside", mix(), true});
  return cases;
}

// Reciprocity error of the BSDF: max relative difference between f(wo, wi) and f(wi, wo) over `pairs` random pairs of
// directions. The index of refraction is set to 2 and the specular weight to 1, because their inverses are exact
// floats: a rounded inverse would describe another boundary. The normal is the z axis, where local and world space
// agree bit for bit from either side.
inline double worst_asymmetry(MaterialCase c, int pairs, std::uint64_t seed) {
  const glm::vec3 up(0, 0, 1);
  const auto greatest = [](glm::vec3 v) { return std::max({v.x, v.y, v.z}); };
  c.material.ior = 2;
  c.material.specular_weight = 1;
  double worst = 0;
  for (int i = 0; i < pairs; ++i) {
    runtime::Sampler sampler(seed, static_cast<std::uint32_t>(i), 0, 0);
    const bool through = i % 2 == 1;
    const glm::vec3 wo = runtime::square_to_cosine_hemisphere(sampler.next2());
    const glm::vec3 other = runtime::square_to_cosine_hemisphere(sampler.next2());
    if (wo.z < 0.01f || other.z < 0.01f) continue;
    const glm::vec3 wi(other.x, other.y, through ? -other.z : other.z);
    const Bsdf here(c.material, up, wo, c.eta(), c.inside);
    const Bsdf there(c.material, through ? -up : up, wi, c.across(through), through != c.inside);
    // Radiance scales with the square of the index of refraction on its side.
    const float index = through ? c.bending() : 1;
    const glm::vec3 forth = here.evaluate(wi).f / other.z * (index * index), back = there.evaluate(wo).f / wo.z;
    if (greatest(back) < 1e-6f) continue;
    worst = std::max(worst, static_cast<double>(greatest(glm::abs(forth - back)) / greatest(back)));
  }
  return worst;
}

// Adds layered materials to materials(): layers are where a BSDF may count energy twice.
inline std::vector<MaterialCase> layered_materials() {
  std::vector<MaterialCase> cases = materials();
  for (float roughness : {0.0f, 0.15f, 0.4f, 0.8f}) {
    for (float diffuse_roughness : {0.0f, 0.5f, 1.0f}) {
      MaterialPoint m = coated(0.3f);
      m.roughness = roughness;
      m.diffuse_roughness = diffuse_roughness;
      cases.push_back({"coated plastic", m});
      m.metalness = 0.5f;
      m.transmission = 0.5f;
      cases.push_back({"all in one", m});
      cases.push_back({"all in one from inside", m, true});
    }
    MaterialPoint m = glass(roughness * roughness);
    m.coat_weight = 0.7f;
    cases.push_back({"coated glass", m});
    cases.push_back({"coated glass from inside", m, true});
    m.thin_walled = true;
    cases.push_back({"coated pane", m});
  }
  return cases;
}

// Materials that reflect or transmit all light.
inline std::vector<MaterialCase> white_materials() {
  std::vector<MaterialCase> cases{{"diffuse", {}}, {"rough diffuse", matte(1)}, {"matte", matte(0)}};
  cases[0].material.base_color = glm::vec3(1);
  for (float roughness : {0.0f, 0.1f, 0.3f, 0.5f, 0.7f, 1.0f}) {
    const float alpha = roughness * roughness;
    cases.push_back({"metal", metal(alpha)});
    cases.push_back({"glass", glass(alpha)});
    cases.push_back({"glass from inside", glass(alpha), true});
    cases.push_back({"pane", glass(alpha, true)});
    cases.push_back({"plastic", principled(roughness)});
    cases.push_back({"plastic from inside", principled(roughness), true});
    for (const MaterialPoint& base : {metal(alpha), principled(roughness)}) {
      for (float coat_roughness : {0.0f, 0.3f}) {
        MaterialCase c{"varnish over metal or plastic", base};
        c.material.coat_weight = coat_roughness > 0 ? 0.7f : 1.0f;
        c.material.coat_roughness = coat_roughness;
        cases.push_back(c);
      }
    }
  }
  return cases;
}

}  // namespace fathom::test
