// A rectangle as the origin sees it: points on it uniform in solid angle.
//
// Source: Urena, Fajardo, King, "An Area-Preserving Parametrization for Spherical Rectangles", 2013. Below a solid
// angle of kLeastSolidAngle the differences of angles it is made of lose their digits: points are uniform in area.
// Tested by: tests/runtime/light_shapes_test.cpp
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <numbers>

#include "runtime/elementary.h"
#include "vm/real.h"

namespace fathom::runtime {

class SphericalRectangle {
 public:
  static constexpr double kLeastSolidAngle = 1e-3;
  static constexpr double kRounding = 1e-9;  // so far below 0 a solid angle is none

  // [x0,x1] x [y0,y1] in the plane at the distance z > 0.
  SphericalRectangle(double x0, double x1, double y0, double y1, double z)
      : x0_(x0), x1_(x1), y0_(y0), y1_(y1), z_(z) {
    // The z components of the normals of the planes through the origin and the sides.
    const double n0 = -y0 / std::sqrt(z * z + y0 * y0), n1 = x1 / std::sqrt(z * z + x1 * x1);
    const double n2 = y1 / std::sqrt(z * z + y1 * y1), n3 = -x0 / std::sqrt(z * z + x0 * x0);
    b0_ = n0;
    b1_ = n2;
    // The sum of the inner angles less a full turn, as turns one after another: one arc tangent for all four.
    const Turn last = angle(n2, n3) * angle(n3, n0), all = angle(n0, n1) * angle(n1, n2) * last;
    k_ = {last.cos, -last.sin};  // what two of them lack to a full turn
    solid_angle_ = vm::real::atan2(all.sin, all.cos);
    if (solid_angle_ < -kRounding) solid_angle_ += 2 * std::numbers::pi;
    if (by_solid_angle()) return;
    const double x = (x0 + x1) / 2, y = (y0 + y1) / 2, d2 = x * x + y * y + z * z;
    solid_angle_ = std::min(area() * z / (d2 * std::sqrt(d2)), 0.5 * kLeastSolidAngle);
  }

  // Steradian; where it is tiny an estimate, above 0.
  double solid_angle() const { return solid_angle_; }

  // x and y of a point.
  glm::dvec2 sample(glm::dvec2 u) const {
    if (!by_solid_angle()) return {x0_ + u.x * (x1_ - x0_), y0_ + u.y * (y1_ - y0_)};
    // The plane through the y direction that cuts off the share u.x, by where its normal's z is `c`.
    const SinCosReal share = sincos_turn(u.x * solid_angle_ / (2 * std::numbers::pi));
    const Turn au = Turn{share.cos, share.sin} * k_;
    const double fu = (au.cos * b0_ - b1_) / au.sin;
    const double c = std::clamp(std::copysign(1 / std::sqrt(fu * fu + b0_ * b0_), fu), -1.0, 1.0);
    const double x = std::clamp(c * z_ / std::max(std::sqrt(1 - c * c), 1e-9), x0_, x1_);
    const double d2 = x * x + z_ * z_;
    const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
    const double h = h0 + u.y * (h1 - h0), rest = 1 - h * h;
    const double y = rest > 1e-12 ? h * std::sqrt(d2 / rest) : y1_;
    return {x, std::clamp(y, y0_, y1_)};
  }

  // Per solid angle, of a point at the distance sqrt(d2) from the origin.
  double pdf(double d2) const { return by_solid_angle() ? 1 / solid_angle_ : d2 * std::sqrt(d2) / (area() * z_); }

 private:
  // An angle as a unit complex number.
  struct Turn {
    double cos, sin;
    Turn operator*(const Turn& b) const { return {cos * b.cos - sin * b.sin, cos * b.sin + sin * b.cos}; }
  };
  static Turn angle(double m, double n) {
    const double cos = std::clamp(-m * n, -1.0, 1.0);
    return {cos, std::sqrt(1 - cos * cos)};
  }
  double area() const { return (x1_ - x0_) * (y1_ - y0_); }
  bool by_solid_angle() const { return solid_angle_ >= kLeastSolidAngle; }

  double x0_, x1_, y0_, y1_, z_;
  double b0_, b1_, solid_angle_;
  Turn k_;
};

}  // namespace fathom::runtime
