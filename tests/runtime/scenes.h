// Scenes for the renderer's tests, from JSON text.
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "compiler/compile.h"

namespace fathom::runtime {

// The scene that `json` says; "version" is supplied. Fails the test when the compiler refuses it.
inline compiler::CompiledScene scene_of(const std::string& json) {
  compiler::Source source("test.json", "{\"version\": 1, " + json + "}");
  compiler::Diagnostics diagnostics;
  auto scene = compiler::compile(source, diagnostics);
  INFO(diagnostics.print(source, compiler::ErrorFormat::Text));
  REQUIRE(scene.has_value());
  return *std::move(scene);
}

}  // namespace fathom::runtime
