// Tone curves: scene-linear light to what a display shows, both linear sRGB; the sRGB signal is encoded afterwards
// (runtime/base/elementary.h).
//
//     none     as it is, cut off at 1
//     filmic   J. Hable, "Filmic Tonemapping for Real-time Rendering", SIGGRAPH course, 2010: 11.2 / 2 becomes white
//     aces     S. Hill's fit of the Academy's RRT and sRGB ODT, in M. Pettineo's "BakingLab", 2016
//     agx      T. Sobotka, "AgX", 2022, by the polynomial of B. Wrensch, "Minimal AgX Implementation", 2023
//     neutral  Khronos Group, "Khronos PBR Neutral Tone Mapper", 2024: keeps colours below 0.8 - 0.04 but for 0.04 of
//              a surface's reflection
//
// Tested by: tests/runtime/image/tone_test.cpp
#pragma once

#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

using compiler::ToneCurve;

// How light becomes a picture.
struct ToneMapping {
  double exposure = 0;  // stops: light is multiplied by 2^exposure first; within -100 and 100
  ToneCurve curve = ToneCurve::None;
};

// In [0,1] each. Negative light and NaN count as none.
glm::dvec3 apply_curve(ToneCurve curve, glm::dvec3 light);

// 2^stops, a float's number, within 2^-100 and 2^100.
double exposure_factor(double stops);

}  // namespace fathom::runtime
