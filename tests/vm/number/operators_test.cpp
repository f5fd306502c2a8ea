// The opcodes that join and alter values, one at a time: compared with their definitions and with each other.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/vm/number/float_bits.h"

namespace fathom::test::operators_test {

using compiler::Kind;
using glm::dvec3;
using vm::Opcode;

// The two operands are the point's x and y: planes whose distance is a coordinate.
TEST_CASE("unary and binary opcodes on a grid", "[number][evaluate][opcode]") {
  const double k = 0.5;
  struct Row {
    Opcode opcode;
    std::vector<double> immediates;
    double (*truth)(double a, double b);
    double units;  // allowed error in units of 2^-24 of max(|a|, |b|, k, result)
  };
  // How far the blend of width 0.5 lies below the minimum of its operands.
  const auto dip = [](double a, double b) {
    const double h = std::max(0.0, 0.5 - std::abs(a - b));
    return h * h / 2;
  };
  static const auto kDip = dip;
  const Row rows[] = {
      {Opcode::Min, {}, [](double a, double b) { return std::min(a, b); }, 0},
      {Opcode::Max, {}, [](double a, double b) { return std::max(a, b); }, 0},
      {Opcode::Subtract, {}, [](double a, double b) { return std::max(a, -b); }, 0},
      {Opcode::SmoothMin, {k, 0.25 / k}, [](double a, double b) { return std::min(a, b) - kDip(a, b); }, 4},
      {Opcode::SmoothMax, {k, 0.25 / k}, [](double a, double b) { return std::max(a, b) + kDip(a, b); }, 4},
      {Opcode::SmoothSubtract, {k, 0.25 / k}, [](double a, double b) { return std::max(a, -b) + kDip(a, -b); }, 4},
      {Opcode::Offset, {k}, [](double, double b) { return b - 0.5; }, 1},
      {Opcode::Onion, {k}, [](double, double b) { return std::abs(b) - 0.5; }, 1},
      {Opcode::Scale, {k}, [](double, double b) { return b * 0.5; }, 0},
      {Opcode::Negate, {}, [](double, double b) { return -b; }, 0},
  };
  const float grid[] = {0, 1e-38f, 1e-20f, 0.25f, 0.3f, 0.5f, 0.8f, 1, 1.25f, 3, 1e6f, 1e30f};
  vm::Workspace workspace;
  for (const Row& row : rows) {
    vm::Program code;
    code.append(Opcode::Plane, 0, {1, 0, 0, 0}, {});
    code.append(Opcode::Plane, 0, {0, 1, 0, 0}, {});
    code.append(row.opcode, 0, row.immediates, {});
    if (vm::info(row.opcode).form == vm::Form::Unary) {  // leave the first operand out of the result
      code.append(Opcode::Tee, 0, {}, {});
      code.append(Opcode::Max, 0, {}, {});
      code.append(Opcode::Load, 0, {}, {});
      code.append(Opcode::Min, 0, {}, {});
      code.locals = 1;
    }
    const vm::VerifiedProgram program = verified(std::move(code));
    for (int i = 0; i < 24 * 24; ++i) {
      const float a = grid[i % 12] * (i / 12 % 2 ? -1.f : 1.f), b = grid[i / 24 % 12] * (i / 288 ? -1.f : 1.f);
      const float z = 0;
      float narrow;
      vm::evaluate_distance(program, {&a, &b, &z}, 1, &narrow, workspace);
      const double truth = row.truth(a, b);
      const double scale = std::max({std::abs(double(a)), std::abs(double(b)), std::abs(truth), k});
      INFO(vm::info(row.opcode).mnemonic << ' ' << a << ' ' << b << " is " << narrow);
      CHECK(std::abs(narrow - truth) <= row.units * 0x1p-24 * scale);
      CHECK(std::abs(vm::evaluate_distance(program, dvec3(a, b, z), workspace) - truth) <= 1e-15 * scale);
    }
  }
}

TEST_CASE("a blend of width 0 is the hard operator, bit for bit", "[number][evaluate][opcode]") {
  vm::Workspace workspace;
  const std::pair<Opcode, Opcode> pairs[] = {
      {Opcode::SmoothMin, Opcode::Min}, {Opcode::SmoothMax, Opcode::Max}, {Opcode::SmoothSubtract, Opcode::Subtract}};
  for (const auto& [smooth, hard] : pairs) {
    const auto program_with = [](Opcode opcode, const std::vector<double>& immediates) {
      vm::Program code;
      code.append(Opcode::Sphere, 0, {1}, {});
      code.append(Opcode::Box, 0, {0.5, 1.5, 1}, {});
      code.append(opcode, 0, immediates, {});
      return verified(std::move(code));
    };
    Random random(1);
    Cloud cloud;
    for (int i = 0; i < 1000; ++i) {
      const dvec3 p = random.in_box(2);
      cloud.add(static_cast<float>(p.x), i % 7 ? static_cast<float>(p.y) : -0.f, static_cast<float>(p.z));
    }
    CHECK(distance_bits(program_with(smooth, {0, 0}), cloud.from(0), cloud.size(), workspace) ==
          distance_bits(program_with(hard, {}), cloud.from(0), cloud.size(), workspace));
  }
}

TEST_CASE("where the operands of a blend tie, its gradient is the mean of theirs", "[number][evaluate][opcode]") {
  // Regression: the die of scenes/showcase.json had gradients of length sqrt 2.5 on its diagonal planes.
  for (const Kind kind : {Kind::SmoothUnion, Kind::SmoothIntersection, Kind::SmoothSubtraction}) {
    CAPTURE(static_cast<int>(kind));
    compiler::Scene scene;
    const double along_x[] = {1, 0, 0, 0}, along_y[] = {0, 1, 0, 0}, k[] = {0.5};
    const compiler::NodeId planes[] = {scene.graph.add(Kind::Plane, along_x, {}),
                                       scene.graph.add(Kind::Plane, along_y, {})};
    scene.root = scene.graph.add(kind, k, planes);
    // the subtracted operand counts with its sign changed
    const double y = kind == Kind::SmoothSubtraction ? -0.25 : 0.25;
    vm::Workspace workspace;
    const dvec3 gradient = vm::evaluate_surface(plain_lowering(scene), {0.25, y, 3}, workspace).gradient;
    CHECK(gradient.x == 0.5);
    CHECK(gradient.y == (kind == Kind::SmoothSubtraction ? -0.5 : 0.5));
    CHECK(gradient.z == 0);
  }
}

}  // namespace fathom::test::operators_test
