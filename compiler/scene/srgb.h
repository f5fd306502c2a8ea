// The sRGB signal of linear light, and back. Source: IEC 61966-2-1:1999.
// Tested by: tests/compiler/scene/srgb_test.cpp
#pragma once

#include "vm/number/real.h"

namespace fathom::compiler {

// Converts linear light to the sRGB signal, both clamped to [0,1]. NaN becomes 0.
inline double srgb_encode(double linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * vm::real::pow(linear, 1 / 2.4) - 0.055;
}

// Converts an sRGB signal in [0,1] to linear light.
inline double srgb_decode(double signal) {
  return signal <= 0.04045 ? signal / 12.92 : vm::real::pow((signal + 0.055) / 1.055, 2.4);
}

}  // namespace fathom::compiler
