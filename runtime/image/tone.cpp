#include "runtime/image/tone.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <numbers>

#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

template <typename Each>
glm::dvec3 each(glm::dvec3 v, const Each& f) {
  return {f(v.x), f(v.y), f(v.z)};
}

// Clamps to [0,1]; NaN becomes 0.
double clamp01(double x) { return x > 0 ? std::min(x, 1.0) : 0; }

// Returns ((x (A x + C B) + D E) / (x (A x + B) + D F)) - E/F in one fraction, so that nothing cancels and 0 gives 0.
double hable(double x) {
  constexpr double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
  return x * (A * (F - E) * x + B * (C * F - E)) / (F * (x * (A * x + B) + D * F));
}

glm::dvec3 filmic(glm::dvec3 light) {
  constexpr double kExposureBias = 2, kWhite = 11.2;
  return each(light, [](double x) { return hable(kExposureBias * x) / hable(kWhite); });
}

glm::dvec3 aces(glm::dvec3 light) {
  // Rows of the paper are columns of GLM. kIn: sRGB to AP1, and the RRT's saturation. kOut: the ODT's saturation, and
  // back to sRGB.
  constexpr glm::dmat3 kIn(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
  constexpr glm::dmat3 kOut(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
  const auto fit = [](double v) {
    return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  };
  return kOut * each(kIn * light, fit);
}

glm::dvec3 agx(glm::dvec3 light) {
  constexpr glm::dmat3 kInset(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992,
                              0.878468636469772, 0.0784336, 0.0792237451477643, 0.0791661274605434,
                              0.879142973793104);
  constexpr glm::dmat3 kOutset(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368,
                               1.15190312990417, -0.0980434501171241, -0.0990297440797205, -0.0989611768448433,
                               1.15107367264116);
  constexpr double kMinStop = -12.47393, kMaxStop = 4.026069;
  const auto contrast = [](double v) {
    if (!(v > 0x1p-100)) v = 0x1p-100;  // below the least stop
    const double x = clamp01((vm::real::log(v) / std::numbers::ln2 - kMinStop) / (kMaxStop - kMinStop));
    return (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
  };
  // The curve yields a signal for a display of gamma 2.2.
  return each(kOutset * each(kInset * light, contrast),
              [](double signal) { return vm::real::pow(clamp01(signal), 2.2); });
}

glm::dvec3 neutral(glm::dvec3 light) {
  constexpr double kF90 = 0.04, kCompressed = 0.8 - kF90, kDesaturation = 0.15;
  const double least = std::min({light.x, light.y, light.z});
  light -= least < 2 * kF90 ? least - least * least / (4 * kF90) : kF90;
  const double peak = std::max({light.x, light.y, light.z});
  if (peak < kCompressed) return light;
  constexpr double d = 1 - kCompressed;
  const double new_peak = 1 - d * d / (peak + d - kCompressed);
  const double share = 1 / (kDesaturation * (peak - new_peak) + 1);
  return light * (new_peak / peak * share) + new_peak * (1 - share);
}

}  // namespace

glm::dvec3 apply_curve(ToneCurve curve, glm::dvec3 light) {
  // Clamps to more than any curve tells from white. The squares stay finite, and an infinity cannot become a NaN.
  light = each(light, [](double x) { return x > 0 ? std::min(x, 0x1p100) : 0; });
  switch (curve) {
    case ToneCurve::None:
      break;
    case ToneCurve::Filmic:
      light = filmic(light);
      break;
    case ToneCurve::Aces:
      light = aces(light);
      break;
    case ToneCurve::Agx:
      light = agx(light);
      break;
    case ToneCurve::Neutral:
      light = neutral(light);
      break;
  }
  return each(light, clamp01);
}

double exposure_factor(double stops) {
  const double limited = std::clamp(stops, -100.0, 100.0), whole = std::round(limited);
  return std::ldexp(vm::real::exp((limited - whole) * std::numbers::ln2), static_cast<int>(whole));
}

}  // namespace fathom::runtime
