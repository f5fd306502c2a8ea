// A rectangle as seen from the origin, sampled nearly uniformly in solid angle, without trigonometry.
//
// The solid angle per area is z (x^2 + y^2 + z^2)^(-3/2). y given x is sampled exactly, by a closed form. x is
// sampled with a density proportional to (x^2 + z^2 + m^2)^(-3/2), where m is the minimum of |y|, which has the same
// form. That density is exact for a rectangle that looks narrow from the origin, and nearly exact otherwise. The
// weights 1 / pdf have a relative variance below .02 if the rectangle is no nearer than half its shorter side, and
// below 1 at a hundredth of that side. Sampling uniformly over the area had .4 and 300. Exact uniformity (Urena,
// Fajardo, King, "An Area-Preserving Parametrization for Spherical Rectangles", 2013) costs an arc tangent and sines,
// and loses digits at small angles.
// Tested by: tests/runtime/light/light_shapes_test.cpp
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace fathom::runtime {

class SphericalRectangle {
 public:
  struct Sample {
    glm::dvec2 at;  // x and y
    double pdf;     // per solid angle; 0: no sample, the rectangle is too small or seen from its edge
  };

  // The rectangle [x0,x1] x [y0,y1] in the plane at distance z > 0.
  SphericalRectangle(double x0, double x1, double y0, double y1, double z)
      : x0_(x0), x1_(x1), y0_(y0), y1_(y1), z_(z) {
    const double least = std::max({y0, -y1, 0.0});
    z2_ = z * z;
    c2_ = z2_ + least * least;
    g0_ = sine(x0, c2_);
    g1_ = sine(x1, c2_);
  }

  Sample sample(glm::dvec2 u) const {
    const double g = g0_ + u.x * (g1_ - g0_);
    const double x = std::clamp(g * std::sqrt(c2_ / std::max(1 - g * g, kLeast)), x0_, x1_);
    const double d2 = x * x + z2_, h0 = sine(y0_, d2), h1 = sine(y1_, d2);
    const double h = h0 + u.y * (h1 - h0);
    const double y = std::clamp(h * std::sqrt(d2 / std::max(1 - h * h, kLeast)), y0_, y1_);
    return {{x, y}, pdf(x, d2, h1 - h0)};
  }

  // Returns the density at any point with this x.
  double pdf(double x) const {
    const double d2 = x * x + z2_;
    return pdf(x, d2, sine(y1_, d2) - sine(y0_, d2));
  }

 private:
  static constexpr double kLeast = 1e-12;

  // Returns a / sqrt(a^2 + b2): the integral of b2 (t^2 + b2)^(-3/2) up to a.
  static double sine(double a, double b2) { return a / std::sqrt(a * a + b2); }

  // Converts (c2 r^-3 / (g1 - g0)) (d2 s^-3 / (h1 - h0)) per area, with r^2 = x^2 + c2 and s^2 = x^2 + y^2 + z^2, to
  // solid angle.
  double pdf(double x, double d2, double heights) const {
    const double widths = g1_ - g0_;
    if (!(widths > kLeast && heights > kLeast)) return 0;
    const double r2 = x * x + c2_;
    return c2_ * d2 / (r2 * std::sqrt(r2) * widths * heights * z_);
  }

  double x0_, x1_, y0_, y1_, z_;
  double z2_, c2_, g0_, g1_;
};

}  // namespace fathom::runtime
