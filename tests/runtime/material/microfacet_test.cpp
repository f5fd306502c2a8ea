#include "runtime/material/microfacet.h"

#include <cmath>

#include "runtime/sampling/warp.h"
#include "tests/support/catch.h"
#include "tests/support/chi_square.h"

namespace fathom::runtime::microfacet_test {
namespace {

glm::vec3 direction(float cos, float turn) {
  const float sin = std::sqrt(1 - cos * cos);
  return {sin * sincos_turn(turn).cos, sin * sincos_turn(turn).sin, cos};
}

TEST_CASE("microfacet: the facets cover the surface once", "[material]") {
  for (float alpha : {0.02f, 0.1f, 0.5f, 1.0f}) {
    const Ggx ggx(alpha);
    // tan = alpha s / (1 - s) distributes the points as the facets.
    const int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double s = (i + 0.5) / n, tan = static_cast<double>(alpha) * s / (1 - s),
                   cos = 1 / std::sqrt(1 + tan * tan);
      const double dtan = static_cast<double>(alpha) / ((1 - s) * (1 - s)) / n;
      const glm::vec3 m(tan * cos, 0, cos);
      sum += 2 * M_PI * tan * cos * cos * cos * static_cast<double>(ggx.d(m)) * cos * dtan;
    }
    CHECK(sum == Approx(1).epsilon(1e-4));
  }
}

TEST_CASE("microfacet: masking is Smith's", "[material]") {
  for (float alpha : {0.02f, 0.3f, 1.0f}) {
    for (float cos : {0.05f, 0.3f, 0.9f}) {
      const Ggx ggx(alpha);
      const auto lambda = [&](double c) {
        const double tan2 = 1 / (c * c) - 1, a = static_cast<double>(alpha);
        return (std::sqrt(1 + a * a * tan2) - 1) / 2;
      };
      const double o = static_cast<double>(cos), i = 0.4;
      CHECK(static_cast<double>(ggx.g1(cos)) == Approx(1 / (1 + lambda(o))).epsilon(1e-5));
      CHECK(static_cast<double>(ggx.g2_by_4_cos(cos, 0.4f)) ==
            Approx(1 / (1 + lambda(o) + lambda(i)) / (4 * o * i)).epsilon(1e-5));
    }
  }
}

TEST_CASE("microfacet: visible normals pass a chi-square test", "[material]") {
  int seed = 0;
  for (float alpha : {0.1f, 0.5f, 1.0f}) {
    for (float cos : {1.0f, 0.5f, 0.05f}) {
      const Ggx ggx(alpha);
      const glm::vec3 wo = direction(cos, 0.3f);
      test::ChiSquareSetup setup;
      setup.samples = 100000;
      setup.seed = static_cast<std::uint64_t>(++seed);
      const auto sample = [&](Sampler& s) { return ggx.sample_visible_normal(wo, s.next2()); };
      const auto pdf = [&](glm::vec3 m) {
        return m.z > 0 ? static_cast<double>(ggx.visible_normal_pdf(wo, m)) : 0.0;
      };
      const test::ChiSquare result = test::chi_square(sample, pdf, setup);
      CAPTURE(alpha, cos, result.describe());
      CHECK(result.integral == Approx(1).epsilon(1e-3));
      CHECK(result.p > test::sidak(0.01, 9));
    }
  }
}

TEST_CASE("microfacet: the chi-square test sees a density that is wrong by a few hundredths", "[material]") {
  const auto sample = [](Sampler& s) { return square_to_cosine_hemisphere(s.next2()); };
  const auto right = [](glm::vec3 w) { return static_cast<double>(square_to_cosine_hemisphere_pdf(w)); };
  const auto wrong = [&](glm::vec3 w) { return right(w) * (w.x > 0 ? 1.03 : 0.97); };
  test::ChiSquareSetup setup;
  setup.samples = 200000;
  setup.rows = 10;
  setup.columns = 20;
  CHECK(test::chi_square(sample, right, setup).p > 0.01);
  CHECK(test::chi_square(sample, wrong, setup).p < 1e-6);
  // From tables of the chi-square distribution: the values that 5 % exceed.
  CHECK(test::chi_square_tail(3.841459, 1) == Approx(0.05).epsilon(1e-5));
  CHECK(test::chi_square_tail(18.307038, 10) == Approx(0.05).epsilon(1e-5));
  CHECK(test::chi_square_tail(124.342113, 100) == Approx(0.05).epsilon(1e-5));
}

}  // namespace
}  // namespace fathom::runtime::microfacet_test
