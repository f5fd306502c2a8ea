// The daylight model: its published zenith luminance, its scale, its colours, its sun.
#include "runtime/light/sky.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/base/color.h"
#include "runtime/light/light_sample_context.h"
#include "tests/support/catch.h"

namespace fathom::runtime::sky_test {
namespace {

compiler::Background::Sky sky_at(double elevation, double turbidity) {
  compiler::Background::Sky sky;
  const double e = elevation * M_PI / 180;
  sky.sun = {std::cos(e), std::sin(e), 0};
  sky.turbidity = turbidity;
  return sky;
}

double lum(glm::vec3 c) { return static_cast<double>(luminance(c)); }

TEST_CASE("sky: the zenith has the luminance of the model, 10 kcd/m^2 being 1", "[light]") {
  for (const double elevation : {10.0, 40.0, 80.0}) {
    for (const double t : {2.5, 5.0}) {
      const double theta = (90 - elevation) * M_PI / 180, chi = (4.0 / 9 - t / 120) * (M_PI - 2 * theta);
      const double truth = ((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192) / 10;
      CAPTURE(elevation, t);
      CHECK(lum(Sky(sky_at(elevation, t)).radiance({0, 1, 0})) == Approx(truth).epsilon(2e-3));
    }
  }
}

TEST_CASE("sky: around noon its mean is about 1, and the zenith is blue", "[light]") {
  const Sky sky(sky_at(60, 3));
  double mean = 0;
  constexpr int kSteps = 100;
  for (int r = 0; r < kSteps; ++r) {
    for (int c = 0; c < kSteps; ++c) {
      const double y = (r + 0.5) / kSteps, s = std::sqrt(1 - y * y), turn = 2 * M_PI * c / kSteps;
      mean += lum(sky.radiance(glm::vec3(s * std::cos(turn), y, s * std::sin(turn)))) / (kSteps * kSteps);
    }
  }
  CAPTURE(mean);
  CHECK(mean > 0.6);
  CHECK(mean < 1.6);
  const glm::vec3 away = sky.radiance(glm::normalize(glm::vec3(-0.5f, 1, 0)));
  CHECK(away.z > 1.5f * away.x);
}

TEST_CASE("sky: the sun gives 100 klx from high up, and is red and dim when low", "[light]") {
  const glm::vec3 high = Sky(sky_at(70, 2.5)).sun_irradiance(), low = Sky(sky_at(3, 2.5)).sun_irradiance();
  CHECK(lum(high) > 9);  // of 13.31 outside the atmosphere
  CHECK(lum(high) < 13.31);
  CHECK(lum(low) < 0.3 * lum(high));
  CHECK(low.x > 3 * low.z);
  compiler::Background::Sky twice = sky_at(70, 2.5);
  twice.strength = 2;
  CHECK(lum(Sky(twice).sun_irradiance()) == Approx(2 * lum(high)));
  CHECK(lum(Sky(twice).radiance({0, 1, 0})) == Approx(2 * lum(Sky(sky_at(70, 2.5)).radiance({0, 1, 0}))));
}

TEST_CASE("sky: every direction has a finite radiance, and the ground is what it reflects", "[light]") {
  for (const double elevation : {0.0, 0.1, 30.0, 90.0}) {
    for (const double t : {2.0, 10.0}) {
      const Sky sky(sky_at(elevation, t));
      for (int i = -200; i <= 200; ++i) {
        const double y = i / 200.0, s = std::sqrt(1 - y * y);
        const glm::vec3 c = sky.radiance(glm::vec3(s, y, 0));
        if (!(c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x + c.y + c.z < 1e4f)) FAIL("at y = " << y);
      }
    }
  }
  compiler::Background::Sky black = sky_at(30, 3);
  black.ground_albedo = glm::dvec3(0);
  CHECK(Sky(black).radiance({0, -1, 0}) == glm::vec3(0));
  CHECK(Sky(sky_at(30, 3)).radiance({0, -1, 0}).y > 0);
}

}  // namespace
}  // namespace fathom::runtime::sky_test
