// Scenes for the renderer's tests, from JSON text.
#pragma once

#include <string>

#include "tests/support/compiled.h"

namespace fathom::runtime {

// The scene that `json` says; "version" is supplied. Fails the test when the compiler refuses it.
inline compiler::CompiledScene scene_of(const std::string& json) {
  return tests::compiled("{\"version\": 1, " + json + "}");
}

}  // namespace fathom::runtime
