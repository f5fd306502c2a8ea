// Compiles scene texts for tests. The test fails when the compiler reports an error.
#pragma once

#include <string>
#include <utility>

#include "compiler/compile.h"
#include "compiler/frontend/formats/write_json.h"
#include "tests/support/catch.h"

namespace fathom::test {

// Compiles a text in any scene format.
inline compiler::CompiledScene compiled(const std::string& text, const compiler::CompileOptions& options = {}) {
  const compiler::Source source("test.json", text);
  compiler::Diagnostics diagnostics;
  auto scene = compiler::compile(source, diagnostics, options);
  INFO(diagnostics.print(source, compiler::ErrorFormat::Text));
  REQUIRE(scene);
  return *std::move(scene);
}

// Compiles `text` and sets `written` to the equivalent JSON scene file.
inline compiler::CompiledScene compiled(const std::string& text, std::string& written) {
  compiler::CompileOptions options;
  options.on_syntax = [&](const compiler::ReadScene& scene) { written = compiler::write_json(scene.file); };
  return compiled(text, options);
}

// Compiles a scene that consists of objects only.
inline compiler::CompiledScene compiled_objects(const std::string& objects,
                                                const compiler::CompileOptions& options = {}) {
  return compiled(R"({"version": 1, "objects": [)" + objects + "]}", options);
}

}  // namespace fathom::test
