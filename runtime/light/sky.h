// The clear sky by day, its sun, and a ground under it.
//
// The sky is Perez' formula with the coefficients of Preetham, Shirley, Smits, "A Practical Analytic Model for
// Daylight", SIGGRAPH 1999, appendix A.2, converted from CIE xyY to linear sRGB. A radiance of 1 is 10 kcd/m^2, about
// the mean of a clear sky around noon. The sun has its angular size, and the extraterrestrial illuminance of 133.1
// klx (Darula, Kittler, Gueymard, "Reference luminous solar constant", 2005). Rayleigh and aerosol scattering
// attenuate the sun's light (Preetham's appendix A.1; ozone, gases and water are left out) at 610, 550 and 465 nm for
// red, green and blue. Below the horizon lies a diffuse ground lit by sky and sun. Tested by:
// tests/runtime/light/sky_test.cpp
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

inline constexpr double kSunAngle = 0.2665;  // degrees, half of the angle that the sun subtends

class Sky {
 public:
  explicit Sky(const compiler::Background::Sky& sky);

  glm::vec3 radiance(glm::vec3 direction) const;  // without the sun
  // Irradiance of a surface that faces the sun, also for a sky without the sun's disc.
  glm::vec3 sun_irradiance() const { return sun_irradiance_; }

 private:
  struct Perez {
    float a, b, c, d, e;
    float zenith;  // the quantity at the zenith over the formula's value there

    float operator()(float cos_theta, float gamma, float cos_gamma) const;
  };
  glm::vec3 above(glm::vec3 direction) const;

  glm::vec3 sun_;
  std::array<Perez, 3> perez_;  // Y in kcd/m^2, x, y
  glm::vec3 sun_irradiance_{0}, ground_{0};
  float scale_;
};

}  // namespace fathom::runtime
