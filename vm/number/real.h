// Elementary functions of one double for every layer, the interpreter's own, because libm's differ from machine to
// machine. Accuracy: vm/number/elementary-inl.h.
// Tested by: tests/vm/number/elementary_test.cpp
#pragma once

#include <numbers>

namespace fathom::vm::real {

inline constexpr double kDegree = std::numbers::pi / 180;  // radians per degree

struct SinCos {
  double sin, cos;
};

double sin(double x);
double cos(double x);
double tan(double x);
// Sine and cosine of an angle given in turns, |turns| <= 2^20, or in degrees, finite. Both are exact at whole quarter
// turns. Absolute error <= 1e-15 in addition to that of the angle.
SinCos sin_cos_turns(double turns);
SinCos sin_cos_degrees(double degrees);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);
double exp(double x);
double log(double x);
double pow(double x, double y);
double noise(double x, double y, double z);  // vm/number/noise-inl.h

}  // namespace fathom::vm::real
