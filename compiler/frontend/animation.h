// Animated scenes. A scene is animated if it declares the parameter `time` (in seconds) or `frame` (a whole number).
// The two parameters are otherwise ordinary: a still uses their defaults, and -D sets them.
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

// Animation settings of a scene, read with the parameters at their defaults.
struct Animation {
  // True if the scene declares the parameter of that name.
  bool time = false, frame = false;
  std::optional<int> frames;
  double fps = kUsualFps;  // frames per second
};

// Returns nullopt if `diagnostics` contains errors afterwards. Adds the imports of a text scene to `source`.
std::optional<Animation> read_animation(Source& source, Diagnostics& diagnostics, const Limits& limits = {},
                                        const Definitions& definitions = {}, const ImportReader& imports = {});

// Returns values for `time` (in seconds) and `frame`, each only if the scene declares that parameter.
Definitions moment(const Animation& animation, int frame, double time);

}  // namespace fathom::compiler
