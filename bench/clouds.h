// What benches of the machine have in common: points to evaluate and scenes to read.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "vm/evaluate.h"

namespace fathom::bench {

struct Cloud {
  std::vector<float> x, y, z;
  vm::Points points() const { return {x.data(), y.data(), z.data()}; }
};

// In the box where the benchmark scenes are.
inline Cloud make_cloud(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> across(-5, 5), up(0, 2);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.x.push_back(across(random));
    cloud.y.push_back(up(random));
    cloud.z.push_back(across(random));
  }
  return cloud;
}

// `path` from the root of the project. Ends the program when the scene has errors.
inline compiler::CompiledScene compile_file(const std::string& path, const compiler::CompileOptions& options = {}) {
  std::ifstream in(std::string(FATHOM_SOURCE_DIR) + "/" + path);
  std::stringstream text;
  text << in.rdbuf();
  compiler::Diagnostics diagnostics;
  const compiler::Source source(path, text.str());
  auto scene = compiler::compile(source, diagnostics, options);
  if (!scene) {
    fmt::print(stderr, "{}", diagnostics.print(source, compiler::ErrorFormat::Text));
    std::exit(1);
  }
  return *std::move(scene);
}

}  // namespace fathom::bench
