// Reads a scene named on a bench's command line.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "compiler/compile.h"
#include "runtime/load/files.h"

namespace fathom::bench {

// Ends the program after a message, with status 74 when the file cannot be read and 65 when it is not a valid scene.
// `pieces` as in CompileOptions.
inline compiler::CompiledScene read_scene(const char* program, const std::string& path, bool pieces = false) {
  std::ifstream file(path);
  if (!file) {
    fmt::print(stderr, "{}: cannot read `{}`\n", program, path);
    std::exit(74);
  }
  const compiler::Source source(path, std::string(std::istreambuf_iterator<char>(file), {}));
  compiler::Diagnostics diagnostics;
  compiler::CompileOptions options;
  runtime::ImportFolder folder;
  folder.folder = std::filesystem::path(path).parent_path();
  options.imports = runtime::import_reader(folder);
  options.pieces = pieces;
  auto scene = compiler::compile(source, diagnostics, options);
  if (!scene) {
    fmt::print(stderr, "{}", diagnostics.print(source, compiler::ErrorFormat::Text));
    std::exit(65);
  }
  return *std::move(scene);
}

}  // namespace fathom::bench
