// Compiles the output of `fathom emit cpp` with these tests and compares it bit for bit with the machine, in float
// and in double.
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "blends.h"
#include "emitted_programs_cpp.h"
#include "hi.h"
#include "scene_a.h"
#include "scene_b.h"
#include "scene_c.h"
#include "scene_e.h"
#include "showcase.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/emitted_programs.h"
#include "tests/support/random/random_scene.h"
#include "tests/vm/number/float_bits.h"

namespace fathom::test::emitted_cpp_test {
namespace {

constexpr std::size_t kPoints = 3000;

// Ordinary points; some on planes and axes, where operands tie; some far out, infinite or NaN.
Cloud cloud_around(std::uint64_t seed) {
  static const float kRare[] = {0.f,
                                -0.f,
                                0.5f,
                                1.f,
                                1e-39f,
                                1e-20f,
                                1e4f,
                                -3.4e38f,
                                std::numeric_limits<float>::infinity(),
                                std::numeric_limits<float>::quiet_NaN()};
  Random random(seed);
  Cloud cloud;
  for (std::size_t i = 0; i < kPoints; ++i) {
    float p[3];
    for (float& c : p) c = static_cast<float>(random.uniform(-2, 2));
    while (random.chance(0.2)) p[random.below(3)] = kRare[random.below(10)];
    cloud.add(p[0], p[1], p[2]);
  }
  return cloud;
}

std::uint64_t bits_of_double(double d) {
  return std::bit_cast<std::uint64_t>(std::isnan(d) ? std::numeric_limits<double>::quiet_NaN() : d);
}

// Number of points at which the emitted code differs from the machine in any bit.
struct Differing {
  std::size_t floats = 0, doubles = 0;
};
Differing differing(const compiler::CompiledScene& scene, float (*in_float)(float, float, float),
                    double (*in_double)(double, double, double)) {
  const Cloud cloud = cloud_around(99);
  vm::Workspace workspace;
  // The machine takes points relative to the scene's origin. The emitted function subtracts the origin itself.
  const auto moved = [](float a, double by) { return by == 0 ? a : a - static_cast<float>(by); };
  Cloud relative;
  for (std::size_t i = 0; i < kPoints; ++i) {
    relative.add(moved(cloud.x[i], scene.origin.x), moved(cloud.y[i], scene.origin.y),
                 moved(cloud.z[i], scene.origin.z));
  }
  const auto machine = distance_bits(scene.distance, relative.from(0), kPoints, workspace);
  Differing result;
  for (std::size_t i = 0; i < kPoints; ++i) {
    result.floats += bits_of(in_float(cloud.x[i], cloud.y[i], cloud.z[i])) != machine[i];
    const glm::dvec3 p(cloud.x[i], cloud.y[i], cloud.z[i]);
    const double doubles = vm::evaluate_distance(scene.distance, p - scene.origin, workspace);
    result.doubles += bits_of_double(in_double(p.x, p.y, p.z)) != bits_of_double(doubles);
  }
  return result;
}

}  // namespace

TEST_CASE("emitted C++ gives the machine's bits for every opcode", "[emit]") {
  const auto programs = emitted_programs();
  REQUIRE(programs.size() == std::size(kEmittedCpp));
  std::set<std::uint32_t> opcodes;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const compiler::CompiledScene& scene = programs[i].scene;
    REQUIRE(programs[i].name == kEmittedCpp[i].name);
    const auto& words = scene.distance.program().words;
    for (std::size_t at = 0; at < words.size(); at += vm::instruction_length(words[at]))
      opcodes.insert(words[at] & 0xff);
    CAPTURE(programs[i].name);
    const Differing result = differing(scene, kEmittedCpp[i].in_float, kEmittedCpp[i].in_double);
    CHECK(result.floats == 0);
    CHECK(result.doubles == 0);
  }
  CHECK(opcodes.size() == std::size_t{vm::kOpcodeCount});
}

TEST_CASE("emitted C++ gives the machine's bits for scene files", "[emit]") {
  const auto check = [](const char* path, float (*in_float)(float, float, float),
                        double (*in_double)(double, double, double)) {
    CAPTURE(path);
    std::stringstream text;
    text << std::ifstream(std::string(FATHOM_SOURCE_DIR "/") + path).rdbuf();
    const Differing result = differing(test::compiled(text.str()), in_float, in_double);
    CHECK(result.floats == 0);
    CHECK(result.doubles == 0);
  };
  check("scenes/bench/a-primitives.json", scene_a::distance<float>, scene_a::distance<double>);
  check("scenes/bench/b-csg.json", scene_b::distance<float>, scene_b::distance<double>);
  check("scenes/bench/c-mandelbulb.json", scene_c::distance<float>, scene_c::distance<double>);
  check("scenes/bench/e-gyroid.json", scene_e::distance<float>, scene_e::distance<double>);
  check("scenes/blends.json", blends::distance<float>, blends::distance<double>);
  check("scenes/showcase.json", showcase::distance<float>, showcase::distance<double>);
  check("tests/data/hi.vm", hi::distance<float>, hi::distance<double>);
}

}  // namespace fathom::test::emitted_cpp_test
