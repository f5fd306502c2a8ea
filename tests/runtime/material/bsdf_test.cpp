#include "runtime/material/bsdf.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <string>
#include <vector>

#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"
#include "tests/support/chi_square.h"
#include "tests/support/materials.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::bsdf_test {
namespace {

using test::coated, test::glass, test::matte, test::metal, test::principled, test::towards;
using test::kCosines, test::kNormal;
using Case = test::MaterialCase;

// Albedo under uniform illumination, without the scaling of radiance by refraction. mean: the largest channel of the
// mean of random samples; deviation: the mean's standard deviation.
struct Albedo {
  double mean, deviation;
};

float greatest(glm::vec3 v) { return std::max({v.x, v.y, v.z}); }

const int kAlbedoSamples = test::scaled_cases(20000);

Albedo albedo(const Case& c, float cos, int n) {
  const Bsdf bsdf = c.bsdf(towards(cos, 0.2f));
  glm::dvec3 sum(0);
  double squares = 0;
  for (int i = 0; i < n; ++i) {
    Sampler sampler(11, static_cast<std::uint32_t>(i), 0, 0);
    const float lobe = sampler.next();
    const BsdfSample s = bsdf.sample(lobe, sampler.next2());
    const glm::dvec3 weight(s.weight * s.eta_scale);
    sum += weight / static_cast<double>(n);
    squares += std::max({weight.x * weight.x, weight.y * weight.y, weight.z * weight.z}) / n;
  }
  const double mean = std::max({sum.x, sum.y, sum.z});
  return {mean, std::sqrt(std::max(squares - mean * mean, 0.0) / n)};
}

TEST_CASE("bsdf: Fresnel's equations at their known points", "[material]") {
  CHECK(fresnel(1, 1.5f) == Approx(0.04).epsilon(1e-6));
  CHECK(fresnel(1, 1 / 1.5f) == Approx(0.04).epsilon(1e-6));
  CHECK(fresnel(0, 1.5f) == Approx(1));
  // Brewster's angle: only the perpendicular polarisation is reflected, by ((1 - n^2) / (1 + n^2))^2.
  const double n = 1.5, brewster = std::cos(std::atan(n)), part = (1 - n * n) / (1 + n * n);
  CHECK(fresnel(static_cast<float>(brewster), 1.5f) == Approx(part * part / 2).epsilon(1e-5));
  // Total internal reflection begins where sin = 1/n.
  const float critical = static_cast<float>(std::sqrt(1 - 1 / (n * n)));
  CHECK(fresnel(critical * 0.999f, 1 / 1.5f) == 1);
  CHECK(fresnel(critical * 1.001f, 1 / 1.5f) < 1);
  CHECK(fresnel(0.3f, 1) == Approx(0).margin(1e-12));
}

TEST_CASE("bsdf: reflectance is the same from both sides", "[material]") {
  for (float cos_i = 0.05f; cos_i < 1; cos_i += 0.05f) {
    const float cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (1.5f * 1.5f));
    CHECK(fresnel(cos_i, 1.5f) == Approx(fresnel(cos_t, 1 / 1.5f)).epsilon(1e-4));
  }
}

TEST_CASE("bsdf: mirrors and Snell's law", "[material]") {
  const glm::vec3 normal(0, 1, 0), wo = glm::normalize(glm::vec3(-1, 1, 0));
  CHECK(glm::length(reflect_about(wo, normal) - glm::normalize(glm::vec3(1, 1, 0))) < 1e-6f);
  const glm::vec3 wi = refract_through(wo, normal, 1.5f);
  CHECK(wi.y < 0);
  CHECK(wi.x * 1.5f == Approx(std::sqrt(0.5)).epsilon(1e-6));
  CHECK(glm::length(wi) == Approx(1).epsilon(1e-6));
}

TEST_CASE("bsdf: glass reflects as often as it reflects light, and tints only what passes", "[material]") {
  MaterialPoint m;
  m.type = MaterialType::Transparent;
  m.base_color = glm::vec3(0.5f);
  const glm::vec3 normal(0, 0, 1), wo = glm::normalize(glm::vec3(1, 0, 0.3f));
  const Bsdf bsdf(m, normal, wo, 1.5f, false);
  CHECK(bsdf.is_delta());
  const double expected = static_cast<double>(fresnel(wo.z, 1.5f));
  const int n = 200000;
  int reflected = 0;
  for (int i = 0; i < n; ++i) {
    Sampler sampler(0, static_cast<std::uint32_t>(i), 0, 0);
    const float lobe = sampler.next();
    const BsdfSample s = bsdf.sample(lobe, sampler.next2());
    reflected += !s.is_transmission;
    CHECK(glm::length(s.weight * s.eta_scale - (s.is_transmission ? glm::vec3(0.5f) : glm::vec3(1))) < 1e-6f);
    CHECK((s.wi.z < 0) == s.is_transmission);
  }
  CHECK(std::abs(reflected - n * expected) < 4 * std::sqrt(n * expected * (1 - expected)));
}

TEST_CASE("bsdf: a sample weighs what is evaluated for its direction", "[material]") {
  for (const Case& c : test::materials()) {
    for (float cos : kCosines) {
      const Bsdf bsdf = c.bsdf(towards(cos, 0.2f));
      CHECK(!bsdf.is_delta());
      double worst = 0;
      for (int i = 0; i < 2000; ++i) {
        Sampler sampler(3, static_cast<std::uint32_t>(i), 0, 0);
        const float lobe = sampler.next();
        const BsdfSample s = bsdf.sample(lobe, sampler.next2());
        if (!(s.pdf > 0)) continue;
        const BsdfValue value = bsdf.evaluate(s.wi);
        const float error = greatest(glm::abs(s.weight * s.pdf - value.f)) / greatest(value.f);
        worst = std::max(worst, static_cast<double>(error));
        if (value.pdf != s.pdf) FAIL(c.name << ": the densities differ");
        if (s.is_transmission != (glm::dot(s.wi, kNormal) < 0)) FAIL(c.name << ": the side is wrong");
      }
      CAPTURE(c.name, cos);
      CHECK(worst <= 1e-6);
    }
  }
}

// Tests the frequencies of samples against their density, for every material from five directions.
void check_densities(int samples, int rows) {
  const std::vector<Case> cases = test::materials();
  const double level = test::sidak(0.01, static_cast<int>(cases.size()) * 5);
  std::uint64_t seed = 0;
  for (const Case& c : cases) {
    for (float cos : kCosines) {
      const Bsdf bsdf = c.bsdf(towards(cos, 0.2f));
      const auto sample = [&](Sampler& sampler) -> std::optional<glm::vec3> {
        const float lobe = sampler.next();
        const BsdfSample s = bsdf.sample(lobe, sampler.next2());
        if (!(s.pdf > 0)) return std::nullopt;
        return s.wi;
      };
      const auto pdf = [&](glm::vec3 wi) { return static_cast<double>(bsdf.evaluate(wi).pdf); };
      test::ChiSquareSetup setup;
      setup.samples = samples;
      setup.rows = rows;
      setup.columns = 2 * rows;
      setup.pole = kNormal;
      setup.seed = ++seed;
      const test::ChiSquare result = test::chi_square(sample, pdf, setup);
      CAPTURE(c.name, cos, result.describe());
      CHECK(result.p > level);
      CHECK(result.integral <= 1.001);
    }
  }
}

TEST_CASE("bsdf: every material passes a chi-square test against its density", "[material]") {
  check_densities(test::scaled_cases(20000), 12);
}

TEST_CASE("bsdf: every material passes a chi-square test of two hundred thousand samples", "[material][heavy]") {
  check_densities(200000, 20);
}

TEST_CASE("bsdf: light goes either way alike", "[material]") {
  for (const Case& c : test::materials()) {
    const double worst = test::worst_asymmetry(c, 4000, 7);
    CAPTURE(c.name, worst);
    CHECK(worst <= 1e-5);
  }
}

TEST_CASE("bsdf: nothing gives more light than it gets", "[material]") {
  for (const Case& c : test::layered_materials()) {
    for (float cos : kCosines) {
      CAPTURE(c.name, c.material.roughness, c.material.diffuse_roughness, cos);
      const Albedo found = albedo(c, cos, kAlbedoSamples);
      CHECK(found.deviation < 1.4 / std::sqrt(kAlbedoSamples));
      CHECK(found.mean - 4 * found.deviation <= 1.001);
    }
  }
}

TEST_CASE("bsdf: what is white loses nothing", "[material]") {
  for (const Case& c : test::white_materials()) {
    for (float cos : kCosines) {
      CAPTURE(c.name, c.material.roughness, cos);
      const Albedo found = albedo(c, cos, kAlbedoSamples);
      CHECK(found.deviation < 1.4 / std::sqrt(kAlbedoSamples));
      CHECK(found.mean == Approx(1).margin(3e-3 + 4 * found.deviation));
    }
  }
}

TEST_CASE("bsdf: varnish over a white surface loses at most a few hundredths", "[material]") {
  for (const MaterialPoint& base : {metal(0.25f), metal(0), principled(0.5f), principled(0)}) {
    for (float coat_roughness : {0.0f, 0.4f}) {
      Case c{"varnish", base};
      c.material.coat_weight = 1;
      c.material.coat_roughness = coat_roughness;
      for (float cos : kCosines) {
        CAPTURE(base.metalness, base.roughness, coat_roughness, cos);
        CHECK(albedo(c, cos, 20000).mean >= 0.95);
      }
    }
  }
}

// Fraction of diffuse light under a smooth boundary that the boundary sends back: total reflection included, by
// Fresnel's equations over the outer hemisphere, in double.
double inner_reflection(double eta) {
  constexpr int kSteps = 100000;
  double passed = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double cos = (i + 0.5) / kSteps;
    passed += 2 * cos * (1 - static_cast<double>(fresnel(static_cast<float>(cos), static_cast<float>(eta)))) / kSteps;
  }
  return 1 - passed / (eta * eta);
}

TEST_CASE("bsdf: a coat darkens what it sends back to the base again and again", "[material]") {
  const glm::vec3 wo = towards(0.95f, 0.1f), wi = towards(0.9f, 0.3f);
  for (const float gray : {0.0f, 0.2f, 0.8f, 1.0f}) {
    MaterialPoint m = coated(0);
    m.base_color = glm::vec3(gray);
    m.metalness = 1;
    m.roughness = 1;
    const float plain = Bsdf(m, kNormal, wo, m.ior, false).evaluate(wi).f.x;
    m.coat_darkening = 1;
    const float dark = Bsdf(m, kNormal, wo, m.ior, false).evaluate(wi).f.x;
    // The sum of the light after 0, 1, 2, ... reflections at the base: (1 - K) / (1 - gray K).
    const double inner = inner_reflection(static_cast<double>(m.coat_ior));
    const double expected = (1 - inner) / (1 - static_cast<double>(gray) * inner);
    CAPTURE(gray, inner);
    CHECK(dark == Approx(static_cast<double>(plain) * expected).epsilon(2e-3));
  }
}

// Regression: the coat's inner side reflected what a mirror sends back to it as if it were diffuse light, and a metal
// of 0.6 under a coat returned 0.379 instead of 0.609.
TEST_CASE("bsdf: a coat over a mirror is as two parallel mirrors", "[material]") {
  MaterialPoint m = metal(0);
  m.coat_weight = m.coat_darkening = 1;
  for (const float coat_ior : {1.2f, 1.6f, 2.5f}) {
    for (const glm::vec3 color : {glm::vec3(0.6f), glm::vec3(1, 0.3f, 0)}) {
      for (const float cos : {1.0f, 0.7f, 0.3f}) {
        CAPTURE(coat_ior, color.y, cos);
        m.coat_ior = coat_ior;
        m.base_color = color;
        const Bsdf bsdf(m, kNormal, towards(cos, 0.1f), m.ior, false);
        glm::dvec3 returned(0);
        constexpr int kLobes = 4096;
        for (int i = 0; i < kLobes; ++i) {
          const float lobe = (static_cast<float>(i) + 0.5f) / kLobes;
          returned += glm::dvec3(bsdf.sample(lobe, {0.3f, 0.7f}).weight) / static_cast<double>(kLobes);
        }
        const glm::dvec3 mirror(F82Tint(color, glm::vec3(1))(cos));
        const double coat = static_cast<double>(fresnel(cos, coat_ior));
        glm::dvec3 expected(coat), light = (1 - coat) * (1 - coat) * mirror;
        for (int bounce = 0; bounce < 200; ++bounce) {
          expected += light;
          light *= coat * mirror;
        }
        CHECK(glm::length(returned - expected) < 2e-3);
        if (color.x == color.y && cos == 1 && coat_ior == 1.6f) CHECK(returned.x == Approx(0.609).margin(1e-3));
      }
    }
  }
}

TEST_CASE("bsdf: a metal has the colours it is given, facing and at 82 degrees", "[material]") {
  MaterialPoint gold = metal(0);
  gold.base_color = {1, 0.7f, 0.3f};
  gold.specular_color = {0.9f, 1, 0.5f};
  const F82Tint tint(gold.base_color, gold.specular_color);
  CHECK(glm::length(Bsdf(gold, kNormal, kNormal, 1.5f, false).sample(0.5f, {0, 0}).weight - gold.base_color) < 1e-5f);
  const float x = 6.0f / 7;
  const glm::vec3 schlick = gold.base_color + (1.0f - gold.base_color) * (x * x * x * x * x);
  CHECK(glm::length(tint(1.0f / 7) - schlick * gold.specular_color) < 1e-5f);
  CHECK(glm::length(tint(0) - glm::vec3(1)) < 1e-5f);
  glm::dvec3 sum(0);
  for (int i = 0; i < 10000; ++i) {
    const float cos = (static_cast<float>(i) + 0.5f) / 10000;
    sum += glm::dvec3(tint(cos) * (2 * cos / 10000));
  }
  CHECK(glm::length(glm::vec3(sum) - tint.average()) < 1e-4f);
}

TEST_CASE("bsdf: radiance is what it was once it has left the glass", "[material]") {
  MaterialPoint smooth;
  smooth.type = MaterialType::Transparent;
  smooth.base_color = glm::vec3(1);
  for (const MaterialPoint& m : {smooth, glass(0)}) {
    const glm::vec3 wo = towards(0.6f, 0.1f);
    const BsdfSample in = Bsdf(m, kNormal, wo, 1.5f, false).sample(0.999f, {0.3f, 0.4f});
    REQUIRE(in.is_transmission);
    CHECK(in.eta_scale == Approx(2.25).epsilon(1e-5));
    CHECK(in.weight.x == Approx(1 / 2.25).epsilon(1e-5));
    // At the far side of a slab.
    const BsdfSample out = Bsdf(m, kNormal, -in.wi, 1 / 1.5f, true).sample(0.999f, {0.3f, 0.4f});
    REQUIRE(out.is_transmission);
    CHECK(in.weight.x * out.weight.x == Approx(1).epsilon(1e-5));
    CHECK(in.eta_scale * out.eta_scale == Approx(1).epsilon(1e-5));
    CHECK(glm::length(out.wi + wo) < 1e-5f);
  }
}

TEST_CASE("bsdf: a thin wall lets straight through what a slab does", "[material]") {
  const Bsdf pane(glass(0, true), kNormal, kNormal, 1.5f, false);
  CHECK(pane.is_delta());
  // T / (1 + R) with R = .04.
  int passed = 0;
  for (int i = 0; i < 10000; ++i) {
    const BsdfSample s = pane.sample((static_cast<float>(i) + 0.5f) / 10000, {0.5f, 0.5f});
    if (!s.is_transmission) continue;
    ++passed;
    if (s.wi != -kNormal || !s.is_null || s.eta_scale != 1) FAIL("bent");
  }
  CHECK(passed / 1e4 == Approx(0.92308).margin(2e-4));
}

TEST_CASE("bsdf: what is not opaque has holes", "[material]") {
  MaterialPoint m = principled(0.5f);
  m.opacity = 0.25f;
  const glm::vec3 wo = towards(0.4f, 0.7f);
  const Bsdf bsdf(m, kNormal, wo, 1.5f, false);
  int holes = 0;
  for (int i = 0; i < 10000; ++i) {
    const BsdfSample s = bsdf.sample((static_cast<float>(i) + 0.5f) / 10000, {0.5f, 0.5f});
    if (!s.is_transmission) continue;
    ++holes;
    if (s.wi != -wo || !s.is_null || s.weight != glm::vec3(1)) FAIL("a hole changes light");
  }
  CHECK(holes == Approx(7500).margin(2));
  CHECK(albedo({"hole", m}, 0.4f, 20000).mean == Approx(1).margin(1e-2));
}

TEST_CASE("bsdf: what goes straight through is the mean of what is drawn so", "[material]") {
  MaterialPoint pane = glass(0, true), hole = principled(0.5f), mirror;
  pane.transmission_color = {0.9f, 0.5f, 0.3f};
  pane.transmission = 0.8f;
  pane.coat_weight = 0.7f;
  pane.coat_color = {0.5f, 0.9f, 0.7f};
  pane.metalness = 0.25f;
  pane.opacity = 0.6f;
  hole.opacity = 0.25f;
  mirror.type = MaterialType::Specular;
  const Case cases[] = {{"pane", pane},
                        {"pane from inside", pane, true},
                        {"hole", hole},
                        {"clear pane", glass(0, true)},
                        {"rough pane", glass(0.2f, true)},
                        {"glass", glass(0)},
                        {"mix", test::mix()},
                        {"mirror", mirror},
                        {"diffuse", {}}};
  for (const Case& c : cases) {
    for (float cos : kCosines) {
      CAPTURE(c.name, cos);
      const glm::vec3 wo = towards(cos, 0.2f);
      const Bsdf bsdf = c.bsdf(wo);
      glm::dvec3 mean(0);
      constexpr int kDraws = 20000;
      for (int i = 0; i < kDraws; ++i) {
        const BsdfSample s = bsdf.sample((static_cast<float>(i) + 0.5f) / kDraws, {0.3f, 0.6f});
        if (!s.is_null) continue;
        if (s.wi != -wo || s.pdf != 0 || !s.is_transmission || s.eta_scale != 1) FAIL("not straight");
        mean += glm::dvec3(s.weight) / static_cast<double>(kDraws);
      }
      for (int i = 0; i < 3; ++i) CHECK(bsdf.null_transmission()[i] == Approx(mean[i]).margin(2e-4));
    }
  }
  const auto facing = [](const MaterialPoint& m) {
    return Bsdf(m, kNormal, kNormal, m.ior, false).null_transmission();
  };
  CHECK(facing(hole) == glm::vec3(0.75f));
  CHECK(facing(glass(0, true)).x == Approx(0.96 / 1.04).epsilon(1e-5));
  CHECK(facing(glass(0.2f, true)) == glm::vec3(0));
}

TEST_CASE("bsdf: light goes straight through either way alike", "[material]") {
  MaterialPoint pane = glass(0, true);
  pane.coat_weight = 0.7f;
  pane.opacity = 0.6f;
  for (float cos : kCosines) {
    const glm::vec3 wo = towards(cos, 0.2f);
    const Bsdf here(pane, kNormal, wo, 1.5f, false), there(pane, -kNormal, -wo, 1.5f, true);
    CHECK(glm::length(here.null_transmission() - there.null_transmission()) < 1e-6f);
  }
}

TEST_CASE("bsdf: mirrors are told from what light sampling can find", "[material]") {
  const auto is_delta = [](const MaterialPoint& m) { return Bsdf(m, kNormal, kNormal, 1.5f, false).is_delta(); };
  MaterialPoint mirror;
  mirror.type = MaterialType::Specular;
  CHECK(is_delta(mirror));
  CHECK(is_delta(metal(0)));
  CHECK(is_delta(glass(0)));
  CHECK(!is_delta(metal(0.01f)));
  CHECK(!is_delta(glass(0.01f)));
  CHECK(!is_delta(principled(0)));
  CHECK(!is_delta(MaterialPoint{}));
  MaterialPoint coated_mirror = metal(0);
  coated_mirror.coat_weight = 1;
  CHECK(is_delta(coated_mirror));
  coated_mirror.coat_roughness = 0.3f;
  CHECK(!is_delta(coated_mirror));
  const BsdfSample s = Bsdf(mirror, kNormal, towards(0.3f, 0), 1.5f, false).sample(0.5f, {0.5f, 0.5f});
  CHECK(s.weight == mirror.base_color);
  CHECK(s.pdf == 0);
}

}  // namespace
}  // namespace fathom::runtime::bsdf_test
