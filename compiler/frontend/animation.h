// Scenes that move: a scene that declares the parameter `time`, in seconds, or `frame`, a whole number, is animated.
// Nothing else about the two is special: a still has their defaults, and -D sets them like any other.
//
//     auto animation = read_animation(source, diagnostics);
//     compile(source, diagnostics, {.definitions = moment(*animation, 37, 37 / animation->fps)});   // frame 37
//
// Tested by: tests/compiler/frontend/animation_test.cpp
#pragma once

#include <optional>
#include <string_view>

#include "compiler/frontend/records/parameters.h"
#include "compiler/frontend/text/parse/imports.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"
#include "compiler/source/source.h"

namespace fathom::compiler {

// What a scene says of its animation, at its parameters' defaults.
struct Animation {
  bool time = false, frame = false;  // whether it declares that parameter
  std::optional<int> frames;
  double fps = kUsualFps;  // frames a second
};

// nullopt when `diagnostics` has errors afterwards. What a text imports is added to the source.
std::optional<Animation> read_animation(Source& source, Diagnostics& diagnostics, const Limits& limits = {},
                                        const Definitions& definitions = {}, const ImportReader& imports = {});

// The values of those of the two parameters that the scene declares, at a time in seconds.
Definitions moment(const Animation& animation, int frame, double time);

}  // namespace fathom::compiler
