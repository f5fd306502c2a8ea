#include "runtime/image/tone.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::runtime::tone_test {
namespace {

constexpr ToneCurve kCurves[] = {ToneCurve::None, ToneCurve::Filmic, ToneCurve::Aces, ToneCurve::Agx,
                                 ToneCurve::Neutral};

double grey(ToneCurve curve, double light) { return apply_curve(curve, glm::dvec3(light)).y; }

TEST_CASE("tone: black stays black, brighter is never darker, and all ends at white", "[image]") {
  for (const ToneCurve curve : kCurves) {
    INFO(compiler::kToneCurves[static_cast<std::size_t>(curve)]);
    CHECK(apply_curve(curve, glm::dvec3(0)) == glm::dvec3(0));
    CHECK(apply_curve(curve, glm::dvec3(-1)) == glm::dvec3(0));
    CHECK(apply_curve(curve, glm::dvec3(NAN)) == glm::dvec3(0));
    double before = 0;
    int darker = 0;
    for (double stop = -20; stop < 12; stop += 0.01) {
      const double shown = grey(curve, std::exp2(stop));
      darker += shown < before - 1e-9;
      before = std::max(before, shown);
      CHECK((shown >= 0 && shown <= 1));
    }
    CHECK(darker == 0);
    for (const double much : {1e6, 1e30, 1e300, std::numeric_limits<double>::infinity()}) {
      CHECK(grey(curve, much) >= 0.98);
      CHECK(grey(curve, much) <= 1);
    }
  }
}

TEST_CASE("tone: none is the light itself, cut off at 1", "[image]") {
  CHECK(apply_curve(ToneCurve::None, {0.25, 1.5, 0}) == glm::dvec3(0.25, 1, 0));
}

TEST_CASE("tone: filmic has Hable's values and his white", "[image]") {
  const auto hable = [](double x) {
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.30;
  };
  for (const double light : {0.01, 0.18, 1.0, 4.0}) {
    CHECK(grey(ToneCurve::Filmic, light) == Approx(hable(2 * light) / hable(11.2)).epsilon(1e-12));
  }
  CHECK(grey(ToneCurve::Filmic, 5.6) == Approx(1).epsilon(1e-12));
  CHECK(grey(ToneCurve::Filmic, 5.5) < 1);
}

TEST_CASE("tone: aces has the fit's values, and strong colours fade to white", "[image]") {
  // For grey, both matrices only scale by the sums of their rows: 1 within 3e-5.
  const auto fit = [](double v) {
    return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  };
  for (const double light : {0.05, 0.18, 1.0, 4.0}) {
    CHECK(grey(ToneCurve::Aces, light) == Approx(fit(light)).epsilon(1e-4));
  }
  const glm::dvec3 red = apply_curve(ToneCurve::Aces, {1, 0, 0}), lamp = apply_curve(ToneCurve::Aces, {100, 0, 0});
  CHECK(red.y < 0.05);
  CHECK(lamp.y > 0.2);
}

TEST_CASE("tone: agx leaves middle grey in the middle, ends at its stops, and turns lamps white", "[image]") {
  // Sobotka's sigmoid maps 0.18 to the signal 0.18^(1/2.4), for a display of gamma 2.2. The polynomial fits the
  // sigmoid within 2 %.
  CHECK(std::pow(grey(ToneCurve::Agx, 0.18), 1 / 2.2) == Approx(std::pow(0.18, 1 / 2.4)).epsilon(0.02));
  CHECK(grey(ToneCurve::Agx, 0.18 * std::exp2(-10)) < 1e-4);
  CHECK(grey(ToneCurve::Agx, 0.18 * std::exp2(6.5)) > 0.98);
  const glm::dvec3 lamp = apply_curve(ToneCurve::Agx, {0, 0, 200});
  CHECK(lamp.x > 0.4);
  CHECK(lamp.z > lamp.x);
}

TEST_CASE("tone: neutral keeps colours below its shoulder but for a reflection of 0.04", "[image]") {
  const glm::dvec3 color{0.6, 0.3, 0.2}, kept = apply_curve(ToneCurve::Neutral, color);
  for (int i = 0; i < 3; ++i) CHECK(kept[i] == Approx(color[i] - 0.04).epsilon(1e-12));
  // Below 0.08 the reflection falls with the square: the smallest channel becomes 6.25 x^2.
  CHECK(apply_curve(ToneCurve::Neutral, {0.3, 0.05, 0.2}).y == Approx(6.25 * 0.05 * 0.05).epsilon(1e-12));
  // The shoulder starts with slope 1, the slope of the part below it.
  const double step = 1e-6, begin = 0.8;
  const double slope = (grey(ToneCurve::Neutral, begin + step) - grey(ToneCurve::Neutral, begin)) / step;
  CHECK(slope == Approx(1).epsilon(1e-3));
  const glm::dvec3 lamp = apply_curve(ToneCurve::Neutral, {50, 1, 1});
  CHECK(lamp.y > 0.5);
}

TEST_CASE("tone: a stop is a factor of two", "[image]") {
  CHECK(exposure_factor(0) == 1);
  CHECK(exposure_factor(3) == 8);
  CHECK(exposure_factor(-2) == 0.25);
  CHECK(exposure_factor(0.5) == Approx(std::sqrt(2.0)).epsilon(1e-15));
  CHECK(exposure_factor(1000) == exposure_factor(100));
}

}  // namespace
}  // namespace fathom::runtime::tone_test
