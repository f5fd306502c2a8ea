// Scenes for the renderer's tests, from JSON text.
#pragma once

#include <string>

#include "tests/support/compiled.h"

namespace fathom::runtime {

// Compiles the scene `json`, to which "version" is added. Fails the test when the compiler refuses the scene.
inline compiler::CompiledScene scene_of(const std::string& json) {
  return test::compiled("{\"version\": 1, " + json + "}");
}

}  // namespace fathom::runtime
