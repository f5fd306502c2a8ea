#include "runtime/light/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/base/angle.h"
#include "runtime/base/elementary.h"
#include "runtime/sampling/piecewise_constant_sphere.h"
#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

constexpr double kSkyUnit = 10;              // kcd/m^2 per unit of radiance
constexpr double kSunOutside = 133.1;        // klx
constexpr float kMinZenithCosine = 1e-4f;    // of the angle from the zenith, by which Perez' formula divides

// Source: IEC 61966-2-1:1999.
glm::vec3 xyY_to_srgb(float x, float y, float Y) {
  const float X = x / y * Y, Z = (1 - x - y) / y * Y;
  const glm::vec3 rgb(3.2406f * X - 1.5372f * Y - 0.4986f * Z, -0.9689f * X + 1.8758f * Y + 0.0415f * Z,
                      0.0557f * X - 0.2040f * Y + 1.0570f * Z);
  return glm::max(rgb, glm::vec3(0));
}

// Evaluates a polynomial in the turbidity whose coefficients are cubics in the sun's angle from the zenith.
double zenith_chromaticity(const double (&m)[3][4], double turbidity, double theta) {
  double result = 0;
  for (const auto& row : m)
    result = result * turbidity + ((row[0] * theta + row[1]) * theta + row[2]) * theta + row[3];
  return result;
}

constexpr double kZenithX[3][4] = {
    {0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}};
constexpr double kZenithY[3][4] = {
    {0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}};

// Returns the part of sunlight of a wavelength, in micrometres, that `mass` air masses let pass, by appendix A.1.
double transmittance(double wavelength, double turbidity, double mass) {
  const double rayleigh = 0.008735 * vm::real::pow(wavelength, -4.08);
  const double aerosol = (0.04608 * turbidity - 0.04586) * vm::real::pow(wavelength, -1.3);
  return vm::real::exp(-(rayleigh + aerosol) * mass);
}

glm::dvec3 sun_through_air(double turbidity, double theta) {
  const double degrees = theta * 180 / kPi;
  const double mass = 1 / (vm::real::cos(theta) + 0.15 * vm::real::pow(93.885 - degrees, -1.253));
  return kSunOutside / kSkyUnit *
         glm::dvec3(transmittance(0.610, turbidity, mass), transmittance(0.550, turbidity, mass),
                    transmittance(0.465, turbidity, mass));
}

// Returns the irradiance of level ground, from the middles of cells of equal height and turn.
template <class Radiance>
glm::dvec3 irradiance_from_above(const Radiance& radiance) {
  constexpr int kRows = 64, kColumns = 128;
  glm::dvec3 sum(0);
  for (int r = 0; r < kRows; ++r) {
    const double y = (r + 0.5) / kRows, sine = std::sqrt(1 - y * y);
    for (int c = 0; c < kColumns; ++c) {
      const SinCos turn = sincos_turn((static_cast<float>(c) + 0.5f) / kColumns);
      sum += y * glm::dvec3(radiance(
                     glm::vec3(sine * static_cast<double>(turn.cos), y, sine * static_cast<double>(turn.sin))));
    }
  }
  return sum * (2 * kPi / (kRows * kColumns));
}

}  // namespace

float Sky::Perez::operator()(float cos_theta, float gamma, float cos_gamma) const {
  return zenith * (1 + a * exp(b / cos_theta)) * (1 + c * exp(d * gamma) + e * cos_gamma * cos_gamma);
}

Sky::Sky(const compiler::Background::Sky& sky) : sun_(sky.sun), scale_(static_cast<float>(sky.strength / kSkyUnit)) {
  const double t = sky.turbidity, theta = vm::real::acos(std::clamp(sky.sun.y, 0.0, 1.0));
  const auto perez = [&](std::array<double, 5> k, double at_zenith) {
    Perez out{float(k[0]), float(k[1]), float(k[2]), float(k[3]), float(k[4]), 1};
    const auto cosine = static_cast<float>(std::clamp(sky.sun.y, 0.0, 1.0));
    out.zenith = static_cast<float>(at_zenith) / out(1, static_cast<float>(theta), cosine);
    return out;
  };
  const double luminance =
      (4.0453 * t - 4.9710) * vm::real::tan((4.0 / 9 - t / 120) * (kPi - 2 * theta)) - 0.2155 * t + 2.4192;
  perez_ = {perez({0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                   -0.0670 * t + 0.3703},
                  luminance),
            perez({-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
                   -0.0033 * t + 0.0452},
                  zenith_chromaticity(kZenithX, t, theta)),
            perez({-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
                   -0.0109 * t + 0.0529},
                  zenith_chromaticity(kZenithY, t, theta))};
  const glm::dvec3 sun = sky.strength * sun_through_air(t, theta);
  sun_irradiance_ = glm::vec3(sun);
  glm::dvec3 level = irradiance_from_above([this](glm::vec3 w) { return above(w); });
  if (sky.sun_disc) level += sun * std::max(sky.sun.y, 0.0);
  ground_ = glm::vec3(sky.ground_albedo * level / kPi);
}

glm::vec3 Sky::above(glm::vec3 direction) const {
  const float cos_theta = std::max(direction.y, kMinZenithCosine);
  const float cos_gamma = std::clamp(glm::dot(direction, sun_), -1.0f, 1.0f);
  const auto gamma = static_cast<float>(vm::real::acos(static_cast<double>(cos_gamma)));
  const auto at = [&](std::size_t i) { return perez_[i](cos_theta, gamma, cos_gamma); };
  return scale_ * xyY_to_srgb(at(1), at(2), std::max(at(0), 0.0f));
}

glm::vec3 Sky::radiance(glm::vec3 direction) const { return direction.y > 0 ? above(direction) : ground_; }

}  // namespace fathom::runtime
