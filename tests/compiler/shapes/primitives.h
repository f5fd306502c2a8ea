// Random primitives, and helpers for tests that hold for every primitive.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "compiler/shapes/node_table.h"
#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test {

inline std::string place(glm::dvec3 p) {
  const auto print = [](double x) { return Catch::StringMaker<double>::convert(x); };
  return print(p.x) + " " + print(p.y) + " " + print(p.z);
}

struct Sample {
  std::vector<double> params;
  compiler::Scene scene;
  std::string name;
};

inline Sample sample(compiler::Kind kind, Random& random) {
  Sample s;
  s.params = random_params(kind, random);
  s.scene = single(kind, s.params);
  s.name = compiler::spec(kind).name;
  for (double k : s.params) s.name += " " + Catch::StringMaker<double>::convert(k);
  return s;
}

// Points inside, around and far from a shape of size 1; some on an axis, a coordinate plane or a diagonal.
inline glm::dvec3 random_point(Random& random) {
  const double half[] = {0.5, 1, 2, 2, 16};
  glm::dvec3 p = random.in_box(half[random.below(5)]);
  if (random.chance(0.1)) p[random.below(3)] = 0;
  if (random.chance(0.05)) p = glm::dvec3(0, p.y, 0);
  if (random.chance(0.03)) p.z = p.x;
  return p;
}

inline double scale_of(glm::dvec3 p) { return std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

inline vm::SurfaceValue evaluate_float(const vm::VerifiedProgram& program, glm::dvec3 p, vm::Workspace& workspace) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float distance, gx, gy, gz;
  std::uint32_t surface;
  vm::evaluate_surface(program, {&x, &y, &z}, 1, {&distance, &gx, &gy, &gz, &surface}, workspace);
  return {distance, {gx, gy, gz}, surface};
}

// True for fractals, whose field is only a distance estimate.
inline bool estimated(compiler::Kind kind) {
  return compiler::spec(kind).facts.outside == compiler::Exactness::Estimate;
}

// True for fields whose gradient may be shorter than 1 on the surface.
inline bool periodic(compiler::Kind kind) {
  return kind == compiler::Kind::Gyroid || kind == compiler::Kind::SchwarzP || kind == compiler::Kind::SchwarzD;
}

// Calls `check` for every solid and every outline.
template <typename Check>
void for_each_primitive(const Check& check) {
  for (const compiler::NodeSpec& row : compiler::node_table()) {
    const bool own_code = row.category == compiler::Category::Primitive && row.code;
    if (own_code) check(row);
  }
}

}  // namespace fathom::test
