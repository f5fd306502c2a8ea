// Points to evaluate and scenes to read, for the benches of the machine.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "vm/interpret/evaluate.h"

namespace fathom::bench {

struct Cloud {
  std::vector<float> x, y, z;
  vm::Points points() const { return {x.data(), y.data(), z.data()}; }
};

// Random points in `box`, or in [-5,5] x [0,2] x [-5,5], the objects' surroundings, when the ground makes the box
// infinite.
inline Cloud make_cloud(std::size_t count, const compiler::Box& box = compiler::Box::everything()) {
  std::mt19937 random(1);
  const bool bounded = box.finite() && !box.empty();
  const glm::vec3 lo = bounded ? glm::vec3(box.lo) : glm::vec3(-5, 0, -5);
  const glm::vec3 hi = bounded ? glm::vec3(box.hi) : glm::vec3(5, 2, 5);
  std::uniform_real_distribution<float> x(lo.x, hi.x), y(lo.y, hi.y), z(lo.z, hi.z);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.x.push_back(x(random));
    cloud.y.push_back(y(random));
    cloud.z.push_back(z(random));
  }
  return cloud;
}

// `path`: absolute, or from the repository's root. Ends the program when the scene has errors.
inline compiler::CompiledScene compile_file(const std::string& path, const compiler::CompileOptions& options = {}) {
  std::ifstream in(std::filesystem::path(FATHOM_SOURCE_DIR) / path);
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
