// Differential fuzz target: the input bytes are the draws of a random graph. Everything that computes the graph's
// distance must agree: the judge, the plain lowering, each pass before and after, the compiler's lowering, the fused
// program, each instruction set, ranges, enclosures and parts (check_program.h), derivatives and differences,
// regions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/lower/fuse.h"
#include "compiler/lower/lower.h"
#include "compiler/passes/containment.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/bounds.h"
#include "runtime/field/regions.h"
#include "tests/fuzz/check_program.h"
#include "tests/fuzz/target.h"
#include "tests/support/judge/judge.h"
#include "tests/support/plain_lowering.h"
#include "vm/interpret/evaluate.h"

namespace fathom::fuzz {
namespace {

using compiler::Scene;
using glm::dvec3;
using test::Random;

constexpr std::size_t kMaxInstructions = 3000;
constexpr std::size_t kComparedPoints = 12;

vm::VerifiedProgram lowered(const Scene& scene) {
  auto code = compiler::lower(scene.graph, scene.root, compiler::Source{}, 100 * kMaxInstructions);
  promise(code.has_value(), "a graph that was small has a program");
  return test::verified(std::move(*code));
}

struct Sampled {
  std::vector<dvec3> points;
  std::vector<double> values;
};

// `allowed` is relative to max(1, |value|).
void check_same(const Sampled& expected, const vm::VerifiedProgram& program, double allowed, std::string_view what,
                vm::Workspace& workspace) {
  for (std::size_t i = 0; i < expected.points.size(); ++i) {
    const dvec3 p = expected.points[i];
    const double is = vm::evaluate_distance(program, p, workspace), was = expected.values[i];
    if (is == was || std::abs(is - was) <= allowed * std::max(1.0, std::abs(was))) continue;
    throw BrokenPromise(fmt::format("{}: {} is not {} at {} {} {}", what, is, was, p.x, p.y, p.z));
  }
}

// A pass that preserves only signs may change any distance, but not its sign.
void check_signs(const Sampled& expected, const vm::VerifiedProgram& program, std::string_view what,
                 vm::Workspace& workspace) {
  for (std::size_t i = 0; i < expected.points.size(); ++i) {
    const dvec3 p = expected.points[i];
    const double is = vm::evaluate_distance(program, p, workspace), was = expected.values[i];
    promise(std::abs(was) < 1e-9 || (is > 0) == (was > 0),
            fmt::format("{}: {} is on the other side than {} at {} {} {}", what, is, was, p.x, p.y, p.z));
  }
}

void check_passes(const Scene& scene, const Sampled& expected, vm::Workspace& workspace) {
  Scene together = scene;
  for (const compiler::Pass& pass : compiler::passes()) {
    const bool signs = pass.leaves == compiler::Pass::Leaves::Sign;
    const vm::VerifiedProgram alone = lowered(pass.run(scene));
    if (signs) {
      check_signs(expected, alone, pass.name, workspace);
    } else {
      check_same(expected, alone, 1e-11, pass.name, workspace);
      together = pass.run(together);
    }
  }
  check_same(expected, lowered(together), 1e-11, "all passes", workspace);
}

// Checks that the fused program gives the same bits.
void check_fused(const vm::VerifiedProgram& plain, const vm::VerifiedProgram& fused, const Sampled& expected,
                 vm::Workspace& workspace) {
  check_same(expected, fused, 0, "fused", workspace);
  for (const dvec3& point : expected.points) {
    const glm::vec3 p(point);
    float a = 0, b = 0;
    vm::evaluate_distance(plain, vm::Points{&p.x, &p.y, &p.z}, 1, &a, workspace);
    vm::evaluate_distance(fused, vm::Points{&p.x, &p.y, &p.z}, 1, &b, workspace);
    promise(a == b || (std::isnan(a) && std::isnan(b)), fmt::format("fused: {} is not {} in float", b, a));
  }
}

// If four differences agree that the field is smooth, the derivative must match them.
void check_derivatives(const vm::VerifiedProgram& program, const Sampled& at, vm::Workspace& workspace) {
  for (std::size_t i = 0; i < at.points.size(); ++i) {
    const dvec3 p = at.points[i];
    const vm::SurfaceValue value = vm::evaluate_surface(program, p, workspace);
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 step(0);
      std::array<double, 4> slopes;
      for (std::size_t n = 0; n < 4; ++n) {
        step[axis] = (n % 2 ? -1e-5 : 1e-5) * (n < 2 ? 1.0 : 0.37);
        slopes[n] = (vm::evaluate_distance(program, p + step, workspace) - at.values[i]) / step[axis];
      }
      const auto [least, most] = std::minmax_element(slopes.begin(), slopes.end());
      const double scale = std::max(1.0, std::abs(*most));
      if (!(*most - *least <= 1e-4 * scale)) continue;
      promise(std::abs(value.gradient[axis] - slopes[0]) <= 1e-3 * scale,
              fmt::format("the derivative {} is not {} along {} at {} {} {}", value.gradient[axis], slopes[0],
                          "xyz"[axis], p.x, p.y, p.z));
    }
  }
}

// Checks that regions give the whole program's rounded distances, bit for bit.
void check_regions(const Scene& scene, const vm::VerifiedProgram& program, Random& random, vm::Workspace& workspace) {
  const auto known = compiler::analyse(scene.graph);
  const compiler::Box contents = compiler::contents(scene.graph, scene.root, known);
  runtime::RegionOptions options;
  options.always = true;
  options.memory = 1u << 20;
  options.cancellation = static_cast<float>(known[scene.root].cancellation);
  const auto regions = runtime::Regions::build(program, contents, options);
  if (!regions) return;
  std::vector<float> x, y, z;
  for (std::size_t i = 0; i < 64; ++i) {
    const double reach = i % 4 == 0 ? 40 : 4;
    x.push_back(static_cast<float>(random.uniform(-reach, reach)));
    y.push_back(static_cast<float>(random.uniform(-reach, reach)));
    z.push_back(static_cast<float>(random.uniform(-reach, reach)));
  }
  std::vector<float> whole(64), cut(64);
  static runtime::RegionScratch scratch;
  vm::evaluate_distance(program, vm::Points{x.data(), y.data(), z.data()}, 64, whole.data(), workspace);
  regions->evaluate({x.data(), y.data(), z.data()}, 64, cut.data(), scratch, workspace);
  regions->far_levels().apply({x.data(), y.data(), z.data()}, 64, whole.data());
  for (std::size_t i = 0; i < 64; ++i) {
    const bool agrees = cut[i] == whole[i] || (std::isnan(cut[i]) && std::isnan(whole[i]));
    promise(agrees, fmt::format("a region's {} is not {} at {} {} {}", cut[i], whole[i], x[i], y[i], z[i]));
  }
}

}  // namespace

void run_differential(Bytes input) {
  if (input.empty()) return;
  Random random(input.subspan(1));
  test::GraphOptions options;
  options.depth = 1 + input[0] % 4;
  options.mandelbulbs = (input[0] >> 2) % 8 == 0;
  const Scene scene = test::random_scene(random, options);
  const vm::VerifiedProgram plain = test::plain_lowering(scene);
  if (plain.instructions() > kMaxInstructions) return;
  vm::Workspace workspace;
  Sampled sampled;
  for (std::size_t i = 0; i < kComparedPoints; ++i) {
    sampled.points.push_back(random.in_box(3));
    sampled.values.push_back(vm::evaluate_distance(plain, sampled.points.back(), workspace));
  }
  if (!options.mandelbulbs) {
    for (std::size_t i = 0; i < kComparedPoints; ++i) {
      const double judged = test::judge_distance(scene.graph, scene.root, sampled.points[i]);
      promise(std::abs(judged - sampled.values[i]) <= 1e-11 * std::max(1.0, std::abs(judged)),
              fmt::format("{} is judged {}", sampled.values[i], judged));
    }
  }
  const vm::VerifiedProgram code = lowered(scene);
  const vm::VerifiedProgram fused = test::verified(compiler::fuse(code.program()));
  check_same(sampled, code, 1e-11, "lowered", workspace);
  check_passes(scene, sampled, workspace);
  Sampled own = sampled;
  for (std::size_t i = 0; i < own.points.size(); ++i) {
    own.values[i] = vm::evaluate_distance(code, own.points[i], workspace);
  }
  check_fused(code, fused, own, workspace);
  check_derivatives(code, own, workspace);
  check_program(plain, random);
  check_program(fused, random);
  check_regions(scene, fused, random, workspace);
}

std::vector<Input> seeds_of_differential() {
  std::vector<Input> seeds;
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    Input& seed = seeds.emplace_back();
    for (int n = 0; n < 8 + 4 * i; ++n) seed.push_back(static_cast<std::uint8_t>(random.bits()));
  }
  return seeds;
}

}  // namespace fathom::fuzz
