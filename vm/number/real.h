// The interpreter's elementary functions of one double. The compiler computes constants with these functions, because
// those of libm differ from machine to machine. Accuracy: vm/number/elementary-inl.h.
// Tested by: tests/vm/number/elementary_test.cpp
#pragma once

namespace fathom::vm::real {

double sin(double x);
double cos(double x);
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);
double exp(double x);
double log(double x);
double pow(double x, double y);
double noise(double x, double y, double z);  // vm/number/noise-inl.h

}  // namespace fathom::vm::real
