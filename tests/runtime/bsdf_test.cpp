#include "runtime/bsdf.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace fathom::runtime {
namespace {

TEST_CASE("bsdf: Fresnel's equations at their known points", "[runtime]") {
  CHECK(fresnel(1, 1.5f) == Approx(0.04).epsilon(1e-6));
  CHECK(fresnel(1, 1 / 1.5f) == Approx(0.04).epsilon(1e-6));
  CHECK(fresnel(0, 1.5f) == Approx(1));
  // Brewster's angle: only the perpendicular half is reflected, ((1 - n^2) / (1 + n^2))^2 of it.
  const double n = 1.5, brewster = std::cos(std::atan(n)), part = (1 - n * n) / (1 + n * n);
  CHECK(fresnel(static_cast<float>(brewster), 1.5f) == Approx(part * part / 2).epsilon(1e-5));
  // Total internal reflection begins where sin = 1/n.
  const float critical = static_cast<float>(std::sqrt(1 - 1 / (n * n)));
  CHECK(fresnel(critical * 0.999f, 1 / 1.5f) == 1);
  CHECK(fresnel(critical * 1.001f, 1 / 1.5f) < 1);
  CHECK(fresnel(0.3f, 1) == Approx(0).margin(1e-12));
}

TEST_CASE("bsdf: reflectance is the same from both sides", "[runtime]") {
  for (float cos_i = 0.05f; cos_i < 1; cos_i += 0.05f) {
    const float cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (1.5f * 1.5f));
    CHECK(fresnel(cos_i, 1.5f) == Approx(fresnel(cos_t, 1 / 1.5f)).epsilon(1e-4));
  }
}

TEST_CASE("bsdf: mirrors and Snell's law", "[runtime]") {
  const glm::vec3 normal(0, 1, 0), wo = glm::normalize(glm::vec3(-1, 1, 0));
  CHECK(glm::length(reflect_about(wo, normal) - glm::normalize(glm::vec3(1, 1, 0))) < 1e-6f);
  const glm::vec3 wi = refract_through(wo, normal, 1.5f);
  CHECK(wi.y < 0);
  CHECK(wi.x * 1.5f == Approx(std::sqrt(0.5)).epsilon(1e-6));
  CHECK(glm::length(wi) == Approx(1).epsilon(1e-6));
}

TEST_CASE("bsdf: glass reflects as often as it reflects light, and tints only what passes", "[runtime]") {
  Material glass{Material::Type::Transparent, glm::vec3(0.5f), glm::vec3(0), 1.5f, glm::vec3(0)};
  const glm::vec3 normal(0, 0, 1), wo = glm::normalize(glm::vec3(1, 0, 0.3f));
  const double expected = static_cast<double>(fresnel(wo.z, 1.5f));
  const int n = 200000;
  int reflected = 0;
  for (int i = 0; i < n; ++i) {
    Sampler sampler(0, static_cast<std::uint32_t>(i), 0, 0);
    const BsdfSample s = sample_bsdf(glass, wo, normal, false, sampler);
    reflected += !s.through;
    CHECK(s.weight == (s.through ? glm::vec3(0.5f) : glm::vec3(1)));
    CHECK((s.wi.z < 0) == s.through);
  }
  CHECK(std::abs(reflected - n * expected) < 4 * std::sqrt(n * expected * (1 - expected)));
}

}  // namespace
}  // namespace fathom::runtime
