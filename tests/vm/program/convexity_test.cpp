// Compares the convexity radius that programs compute (vm/number/convexity-inl.h) with the definition of a convex
// function: no chord lies below the function.
#include "vm/program/convexity.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "compiler/shapes/bounds.h"
#include "tests/support/catch.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "tests/vm/number/float_bits.h"
#include "vm/interpret/evaluate.h"
#include "vm/program/opcode_rows.h"

namespace fathom::test::convexity_test {
namespace {

using compiler::Kind;
using glm::dvec3;

std::set<vm::Opcode> convex_shapes_of(const vm::Code& program) {
  std::set<vm::Opcode> found;
  for (std::size_t at = 0; at < program.size; at += vm::instruction_length(program.words[at])) {
    const auto opcode = static_cast<vm::Opcode>(program.words[at] & 0xff);
    if (vm::has(opcode, vm::Fact::Convex)) found.insert(opcode);
  }
  return found;
}

}  // namespace

TEST_CASE("convexity: no chord of a convex shape's distance lies below it", "[program][convexity]") {
  std::set<vm::Opcode> seen;
  vm::Workspace workspace;
  Random random(41);
  for (const compiler::Sort sort : {compiler::Sort::Solid, compiler::Sort::Outline}) {
    for (const Kind kind : primitive_kinds(sort, false)) {
      for (int round = 0; round < 20; ++round) {
        const vm::VerifiedProgram program = plain_lowering(single(kind, random_params(kind, random)));
        // Some shapes of several instructions are convex in every part but not as a whole. The test skips these
        // shapes.
        if (program.instructions() > 1 || vm::convex_share(program) < 1) continue;
        seen.merge(convex_shapes_of(program));
        CHECK(std::isinf(vm::evaluate_surface(program, random.in_box(2), workspace).convex));
        double worst = 0;
        for (int i = 0; i < 200; ++i) {
          const dvec3 a = random.in_box(2), b = random.in_box(2);
          const double share = random.uniform(0, 1), fa = vm::evaluate_distance(program, a, workspace),
                       fb = vm::evaluate_distance(program, b, workspace);
          const double between = vm::evaluate_distance(program, a + share * (b - a), workspace);
          worst = std::max(worst, between - (fa + share * (fb - fa)));
        }
        INFO(compiler::spec(kind).name);
        CHECK(worst <= 1e-9);
      }
    }
  }
  CHECK(seen.size() >= 26);
}

// Takes three points on a line within the convexity radius of p. If all three are nearer to the solid than any
// non-convex part can come, the value at the middle point is at most the chord's.
TEST_CASE("convexity: what random scenes tell holds", "[program][convexity]") {
  vm::Workspace workspace;
  int far_reaching = 0, tried = 0;
  for (int seed = 0; seed < scaled_cases(400); ++seed) {
    Random random(seed);
    GraphOptions options;
    options.depth = 3;
    const compiler::Scene scene = random_scene(random, options);
    const compiler::NodeFacts known = compiler::analyse(scene.graph)[scene.root];
    if (!known.certified || !std::isfinite(known.lipschitz)) continue;
    const vm::VerifiedProgram program = plain_lowering(scene);
    for (int i = 0; i < 200; ++i) {
      const dvec3 p = random.in_box(2.5), direction = random.direction();
      const vm::SurfaceValue at = vm::evaluate_surface(program, p, workspace);
      CHECK(at.convex >= std::abs(at.distance));
      const double reach = std::min(at.convex / known.lipschitz, 5.0);
      double t[3] = {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
      std::sort(t, t + 3);
      double f[3];
      bool near = true;
      for (int k = 0; k < 3; ++k) {
        f[k] = vm::evaluate_distance(program, p + t[k] * direction, workspace);
        near = near && f[k] < at.convex - known.lipschitz * std::abs(t[k]) - 1e-9;
        f[k] = std::max(f[k], 0.0);
      }
      if (!near || !(t[2] - t[0] > 1e-6)) continue;
      ++tried;
      far_reaching += at.convex > 2 * std::abs(at.distance);
      const double chord = f[0] + (f[2] - f[0]) * (t[1] - t[0]) / (t[2] - t[0]);
      INFO("seed " << seed << ", point " << i);
      CHECK(f[1] <= chord + 1e-8);
    }
  }
  CHECK(tried > scaled_cases(4000));
  CHECK(far_reaching > scaled_cases(2000));
}

TEST_CASE("convexity: distances beside it have the same bits, and it has them on every instruction set",
          "[program][convexity][isa]") {
  const IsaGuard guard;
  vm::Workspace workspace;
  constexpr std::size_t kPoints = 300;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const vm::VerifiedProgram program = plain_lowering(random_scene(random));
    Cloud cloud;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const dvec3 p = random.in_box(2);
      cloud.add(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    }
    std::vector<std::uint32_t> first;
    for (const std::string_view isa : vm::available_isas()) {
      REQUIRE(vm::force_isa(isa));
      std::vector<float> distance(kPoints), convex(kPoints);
      vm::evaluate_convex(program, cloud.from(0), kPoints, distance.data(), convex.data(), workspace);
      std::vector<std::uint32_t> bits;
      for (const float d : distance) bits.push_back(bits_of(d));
      INFO("seed " << seed << ", " << isa);
      CHECK(bits == distance_bits(program, cloud.from(0), kPoints, workspace));
      for (const float c : convex) bits.push_back(bits_of(c));
      if (first.empty()) first = bits;
      CHECK(bits == first);
    }
  }
}

}  // namespace fathom::test::convexity_test
