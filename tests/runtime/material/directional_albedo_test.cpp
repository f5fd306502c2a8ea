#include "runtime/material/directional_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "runtime/material/fresnel.h"
#include "runtime/material/microfacet.h"
#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::energy_test {
namespace {

constexpr Lattice kFine{10946, 6765};

TEST_CASE("energy: what GGX mirrors reflect is as two other quadratures say", "[material]") {
  struct Row {
    float alpha;
    std::array<double, 4> albedo;  // at cosines 1, .8, .5, .2
  };
  const std::array<float, 4> cosines{1, 0.8f, 0.5f, 0.2f};
  const Row rows[] = {{0.1f, {0.98830, 0.98456, 0.96921, 0.9046}},
                      {0.25f, {0.91581, 0.89727, 0.85726, 0.84816}},
                      {0.5f, {0.68785, 0.68205, 0.69825, 0.78993}},
                      {0.75f, {0.46392, 0.49232, 0.56462, 0.71553}},
                      {1, {0.30685, 0.35126, 0.45069, 0.64165}}};
  for (const Row& row : rows) {
    const DirectionalAlbedo lost = conductor_loss(row.alpha);
    for (std::size_t i = 0; i < 4; ++i) {
      CAPTURE(row.alpha, cosines[i]);
      CHECK(1 - static_cast<double>(integrate_conductor_loss(cosines[i], row.alpha, kFine)) ==
            Approx(row.albedo[i]).margin(2e-4));
      CHECK(1 - static_cast<double>(lost.at(cosines[i])) == Approx(row.albedo[i]).margin(2e-3));
    }
  }
  CHECK(static_cast<double>(conductor_loss(1).at(1)) == Approx(std::log(2.0)).margin(1e-3));
}

TEST_CASE("energy: tables are within 1.5e-2 of their integrals, 1.5e-3 in the mean", "[material]") {
  const int n = test::scaled_cases(100);
  std::array<double, 4> worst{}, squares{};
  Sampler sampler(5, 0, 0, 0);
  for (int i = 0; i < n; ++i) {
    const float cos = sampler.next(), u = sampler.next(), v = sampler.next();
    const float alpha = 1e-3f + 0.999f * u * u * u, eta = 1.02f + 2.9f * v * v;
    const InterfaceAlbedo outside = integrate_dielectric(cos, alpha, eta, kFine);
    const InterfaceAlbedo inside = integrate_dielectric(cos, alpha, 1 / eta, kFine);
    const std::array<float, 4> errors{conductor_loss(alpha).at(cos) - integrate_conductor_loss(cos, alpha, kFine),
                                      reflection_albedo(alpha, eta).at(cos) - outside.reflected,
                                      dielectric_loss(alpha, eta).at(cos) - outside.lost,
                                      dielectric_loss(alpha, 1 / eta).at(cos) - inside.lost};
    for (std::size_t k = 0; k < 4; ++k) {
      const double error = std::abs(static_cast<double>(errors[k]));
      worst[k] = std::max(worst[k], error);
      squares[k] += error * error / n;
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    CAPTURE(k, worst[k], std::sqrt(squares[k]));
    CHECK(worst[k] <= 1.5e-2);
    CHECK(std::sqrt(squares[k]) <= 1.5e-3);
  }
}

// Accurate enough that materials return at most a thousandth more than they receive, also glass within which light is
// reflected again and again. Regression: the cosines of the tables were far apart near the critical angle, and a ball
// of roughness 0.3 returned 1.0041 of the light.
TEST_CASE("energy: what glass loses is known on both sides, by roughness and index", "[material]") {
  for (const float roughness : {0.1f, 0.2f, 0.3f, 0.4f, 0.6f, 0.8f, 1.0f}) {
    for (const float eta : {1.1f, 1.3f, 1.5f, 1.65f, 1.8f, 2.0f, 2.25f, 2.5f}) {
      for (const float index : {eta, 1 / eta}) {
        CAPTURE(roughness, index);
        const float alpha = roughness * roughness;
        const DirectionalAlbedo lost = dielectric_loss(alpha, index);
        double sum = 0, worst = 0;
        constexpr int kSteps = 16;
        for (int i = 0; i < kSteps; ++i) {
          const float cos = std::sqrt((static_cast<float>(i) + 0.5f) / kSteps);
          const auto error = static_cast<double>(lost.at(cos) - integrate_dielectric(cos, alpha, index, kFine).lost);
          sum += error / kSteps;
          worst = std::max(worst, std::abs(error));
        }
        CHECK(std::abs(sum) < 3e-4);
        CHECK(worst < 1.5e-3);
      }
    }
  }
}

TEST_CASE("energy: a row's average is that of the function it gives", "[material]") {
  for (const DirectionalAlbedo& row :
       {smooth_albedo(1.5f), conductor_loss(0.05f), conductor_loss(0.01f), dielectric_loss(0.6f, 1 / 1.5f)}) {
    double sum = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double cos = (i + 0.5) / n;
      sum += static_cast<double>(row.at(static_cast<float>(cos))) * 2 * cos / n;
    }
    CHECK(static_cast<double>(row.average()) == Approx(sum).epsilon(1e-3));
  }
  CHECK(DirectionalAlbedo::constant(0.25f).average() == Approx(0.25).epsilon(1e-5));
  CHECK(DirectionalAlbedo::constant(0.25f).at(0.3f) == Approx(0.25).epsilon(1e-5));
}

TEST_CASE("energy: a smooth dielectric reflects as Fresnel's equations say", "[material]") {
  for (float eta : {1.1f, 1.5f, 3.0f}) {
    const DirectionalAlbedo row = smooth_albedo(eta);
    double worst = 0;
    for (float cos = 0; cos <= 1; cos += 1e-3f) {
      worst = std::max(worst, std::abs(static_cast<double>(row.at(cos) - fresnel(cos, eta))));
    }
    CHECK(worst <= 3e-4);
  }
  // Diffuse reflectance of glass, Duntley 1942: .0918.
  CHECK(smooth_albedo(1.5f).average() == Approx(0.0918).margin(1e-4));
}

TEST_CASE("energy: threads that ask at once get the same table", "[material]") {
  std::array<DirectionalAlbedo, 4> rows;
  std::vector<std::thread> threads;
  for (DirectionalAlbedo& row : rows) threads.emplace_back([&row] { row = dielectric_loss(0.37f, 1.77f); });
  for (std::thread& thread : threads) thread.join();
  for (const DirectionalAlbedo& row : rows) CHECK(row.node == rows[0].node);
}

// Compares the tables with their definition, at other points.
TEST_CASE("energy: what a coat takes too much is the mean of what it dims more", "[material]") {
  const DirectionalAlbedo coat = smooth_albedo(1.6f);
  Sampler sampler(9, 0, 0, 0);
  for (const float alpha : {0.05f, 0.3f, 0.8f}) {
    const Ggx ggx(alpha);
    const DirectionalAlbedo metal = coat_loss_of_conductor(alpha, coat),
                            glass = coat_loss_of_reflection(alpha, 1.5f, coat);
    for (const float cos : {1.0f, 0.7f, 0.4f, 0.15f}) {
      const glm::vec3 wo(std::sqrt(1 - cos * cos), 0, cos);
      double of_metal = 0, of_glass = 0;
      constexpr int kPoints = 20000;
      for (int i = 0; i < kPoints; ++i) {
        const glm::vec3 m = ggx.sample_visible_normal(wo, sampler.next2());
        const float cos_m = std::min(glm::dot(wo, m), 1.0f), cos_i = 2 * cos_m * m.z - cos;
        if (!(cos_i > 0)) continue;
        const double more = static_cast<double>(std::max(0.0f, coat.at(cos_i) - coat.at(cos)));
        of_metal += more * static_cast<double>(ggx.g2_over_g1(cos, cos_i)) / kPoints;
        of_glass += more * static_cast<double>(ggx.g2_over_g1(cos, cos_i) * fresnel(cos_m, 1.5f)) / kPoints;
      }
      CAPTURE(alpha, cos);
      CHECK(static_cast<double>(metal.at(cos)) == Approx(of_metal).margin(4e-3));
      CHECK(static_cast<double>(glass.at(cos)) == Approx(of_glass).margin(4e-3));
    }
  }
}

}  // namespace
}  // namespace fathom::runtime::energy_test
