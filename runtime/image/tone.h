// Tone curves: map scene-linear light to the light of a display, both linear sRGB. The sRGB signal is encoded
// afterwards (compiler/scene/srgb.h).
//
//     none     as it is, clipped at 1
//     filmic   J. Hable, "Filmic Tonemapping for Real-time Rendering", SIGGRAPH course, 2010: 11.2 / 2 becomes white
//     aces     S. Hill's fit of the Academy's RRT and sRGB ODT, in M. Pettineo's "BakingLab", 2016
//     agx      T. Sobotka, "AgX", 2022, by the polynomial of B. Wrensch, "Minimal AgX Implementation", 2023
//     neutral  Khronos Group, "Khronos PBR Neutral Tone Mapper", 2024: keeps colours below 0.8 - 0.04, except for
//              0.04 of a surface's reflection
//
// Tested by: tests/runtime/image/tone_test.cpp
#pragma once

#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

using compiler::ToneCurve;

// How light becomes an image for display.
struct ToneMapping {
  double exposure = 0;  // stops: light is first multiplied by 2^exposure; within -100 and 100
  ToneCurve curve = ToneCurve::None;
};

// Returns values in [0,1] each. Negative light and NaN count as 0.
glm::dvec3 apply_curve(ToneCurve curve, glm::dvec3 light);

// Returns 2^stops within 2^-100 and 2^100, exact for whole stops.
double exposure_factor(double stops);

}  // namespace fathom::runtime
