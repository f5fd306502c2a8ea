// Tests of traces: the stack heights are the verifier's, and the last value is the machine's result at the point.
#include "vm/interpret/trace.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_program.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::trace_test {

TEST_CASE("a trace's last value is the program's, and its stacks are as high as the verifier says",
          "[interpret][trace]") {
  vm::Workspace workspace;
  for (int seed = 0; seed < scaled_cases(400); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const vm::VerifiedProgram program = random_program(random, 1 + seed % 40);
    const glm::dvec3 point = random.in_box(2);
    const float x = static_cast<float>(point.x), y = static_cast<float>(point.y), z = static_cast<float>(point.z);
    float expected = 0;
    vm::evaluate_distance(program, {&x, &y, &z}, 1, &expected, workspace);
    std::size_t steps = 0, max_values = 0, max_points = 1;
    vm::TraceStep last;
    vm::trace(program, point, [&](const vm::TraceStep& step) {
      ++steps;
      max_values = std::max(max_values, step.values.size());
      max_points = std::max(max_points, step.points.size());
      last = step;
    });
    CAPTURE(seed);
    CHECK(steps == program.instructions());
    CHECK(max_values == program.max_values());
    CHECK(max_points == program.max_points());
    REQUIRE(last.values.size() == 1);
    REQUIRE(last.points.size() == 1);
    const bool both_nan = std::isnan(expected) && std::isnan(last.values[0]);
    CHECK((both_nan || std::bit_cast<std::uint32_t>(expected) == std::bit_cast<std::uint32_t>(last.values[0])));
  }
}

TEST_CASE("a trace shows what each instruction leaves", "[interpret][trace]") {
  vm::Program program;
  program.append(vm::Opcode::Translate, 0, {1, 0, 0}, {});
  program.append(vm::Opcode::X, 0, {}, {});
  program.append(vm::Opcode::Sqrt, 0, {}, {});
  program.append(vm::Opcode::Drop, 0, {}, {});
  const auto verified = std::get<vm::VerifiedProgram>(vm::verify(program));
  std::vector<vm::TraceStep> steps;
  vm::trace(verified, {0, 2, 3}, [&](const vm::TraceStep& step) { steps.push_back(step); });
  REQUIRE(steps.size() == 4);
  CHECK(steps[0].points == std::vector<glm::vec3>{{0, 2, 3}, {-1, 2, 3}});
  CHECK(steps[1].values == std::vector<float>{-1});
  CHECK(std::isnan(steps[2].values[0]));
  CHECK(steps[2].offset == 5);
  CHECK(steps[3].points.size() == 1);
}

// y + sqrt(x) with x < 0: the root is at fault, not the sum that takes the root's value.
TEST_CASE("a trace finds the first instruction without a finite value", "[interpret][trace]") {
  vm::Program code;
  code.append(vm::Opcode::Y, 0, {}, {});
  code.append(vm::Opcode::X, 0, {}, {});
  const std::size_t root = code.words.size();
  code.append(vm::Opcode::Sqrt, 0, {}, {});
  code.append(vm::Opcode::Add, 0, {}, {});
  const vm::VerifiedProgram program = verified(std::move(code));
  CHECK(vm::first_not_finite(program, {-1, 0, 0}) == root);
  CHECK_FALSE(vm::first_not_finite(program, {4, 1, 0}));
}

}  // namespace fathom::test::trace_test
