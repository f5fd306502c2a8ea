// FLIP: how different two images look when a viewer flips between them, from 0 (alike) to 1 (black against white is
// 0.967).
//
// Source: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020. Colours are filtered as the eye filters them at a viewing distance and compared in
// L*a*b*. The difference is raised where edges or points differ.
//
// Tested by: tests/runtime/image/flip_test.cpp
#pragma once

#include <vector>

#include "runtime/image/image_diff.h"

namespace fathom::runtime {

// A screen 0.7 m wide with 3840 pixels, seen from 0.7 m: the paper's default.
inline constexpr float kPixelsPerDegree = 67;

struct Flip {
  std::vector<float> map;  // [y][x], each in [0,1]
  double mean = 0;
};

// Compares the images as a screen shows them: values are clamped to [0,1], NaN counts as 0. The images must be of one
// size. Exchanging `a` and `b` changes nothing.
Flip flip(RgbView a, RgbView b, float pixels_per_degree = kPixelsPerDegree);

}  // namespace fathom::runtime
