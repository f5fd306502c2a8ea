// Compares the elementary functions with libm: f32 kernels with double, double kernels with long double. Also checks
// their values at the edges of their domains.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <thread>

#include "tests/support/catch.h"
#include "tests/vm/interpret/formula.h"
#include "vm/number/real.h"

namespace fathom::test::elementary_test {
namespace {

using vm::Opcode;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Kernel {
  Opcode opcode;
  double (*truth)(double);
  long double (*long_truth)(long double);
  double limit;  // max |x| for which the error bound holds
};

const Kernel kKernels[] = {
    {Opcode::Sin, std::sin, std::sin, 1e4},     {Opcode::Cos, std::cos, std::cos, 1e4},
    {Opcode::Tan, std::tan, std::tan, 1e4},     {Opcode::Asin, std::asin, std::asin, 1},
    {Opcode::Acos, std::acos, std::acos, 1},    {Opcode::Atan, std::atan, std::atan, 1e39},
    {Opcode::Exp, std::exp, std::exp, 1e39},    {Opcode::Log, std::log, std::log, 1e39},
    {Opcode::Sqrt, std::sqrt, std::sqrt, 1e39},
};

// Error of `value` in ulps of the true value. Infinite when exactly one of them is NaN or infinite.
double ulps(float value, double truth) {
  const float nearest = static_cast<float>(truth);
  if (std::isnan(truth) || std::isinf(nearest)) {
    return std::isnan(truth) == std::isnan(value) && (std::isnan(truth) || value == nearest) ? 0 : kInf;
  }
  const double ulp = std::max(0x1p-149, std::ldexp(1.0, std::ilogb(truth == 0 ? 1e-60 : truth) - 23));
  const double off = std::abs(value - truth) / ulp;
  return off <= 1e30 ? off : kInf;
}

struct Worst {
  double ulps = 0;
  float at = 0;
};

// Worst error over the floats whose bit patterns are first, first + stride, ... below `end`.
Worst worst_of(const Kernel& kernel, std::uint64_t first, std::uint64_t end, std::uint64_t stride) {
  const vm::VerifiedProgram program = formula({{Opcode::X}, {kernel.opcode}});
  vm::Workspace workspace;
  Worst worst;
  constexpr std::size_t kBlock = 4096;
  std::vector<float> x(kBlock), value(kBlock);
  for (std::uint64_t bits = first; bits < end;) {
    std::size_t size = 0;
    for (; size < kBlock && bits < end; bits += stride) {
      const float at = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      if (std::abs(at) <= kernel.limit) x[size++] = at;
    }
    vm::evaluate_distance(program, {x.data(), x.data(), x.data()}, size, value.data(), workspace);
    for (std::size_t i = 0; i < size; ++i) {
      const double off = ulps(value[i], kernel.truth(x[i]));
      if (off > worst.ulps) worst = {off, x[i]};
    }
  }
  return worst;
}

double value_of(Opcode opcode, double x) {
  vm::Workspace workspace;
  return vm::evaluate_distance(formula({{Opcode::X}, {opcode}}), glm::dvec3(x, 0, 0), workspace);
}
float float_of(Opcode opcode, float x) {
  vm::Workspace workspace;
  return evaluate_float(formula({{Opcode::X}, {opcode}}), {x, 0, 0}, workspace);
}
float float_of(Opcode opcode, float a, float b) {
  vm::Workspace workspace;
  return evaluate_float(formula({{Opcode::X}, {Opcode::Y}, {opcode}}), {a, b, 0}, workspace);
}
bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

TEST_CASE("float kernels are within 4 ulp, on a sample", "[number][elementary]") {
  for (const Kernel& kernel : kKernels) {
    const Worst worst = worst_of(kernel, 7, std::uint64_t{1} << 32, 9973);
    INFO(vm::info(kernel.opcode).mnemonic << ": " << worst.ulps << " ulp at " << worst.at);
    CHECK(worst.ulps <= 4);
  }
}

// Takes ten minutes: build/release/tests/fathom_tests "[exhaustive]"
TEST_CASE("float kernels are within 4 ulp, on every float", "[.][exhaustive]") {
  for (const Kernel& kernel : kKernels) {
    constexpr std::uint64_t kParts = 4, kAll = std::uint64_t{1} << 32;
    Worst worst[kParts];
    std::vector<std::thread> threads;
    for (std::uint64_t i = 0; i < kParts; ++i) {
      threads.emplace_back([&, i] { worst[i] = worst_of(kernel, kAll / kParts * i, kAll / kParts * (i + 1), 1); });
    }
    for (std::thread& thread : threads) thread.join();
    const Worst most = *std::max_element(worst, worst + kParts, [](auto& a, auto& b) { return a.ulps < b.ulps; });
    WARN(vm::info(kernel.opcode).mnemonic << ": " << most.ulps << " ulp at " << most.at);
    CHECK(most.ulps <= 4);
  }
}

TEST_CASE("double kernels are within 1e-14", "[number][elementary]") {
  vm::Workspace workspace;
  for (const Kernel& kernel : kKernels) {
    const vm::VerifiedProgram program = formula({{Opcode::X}, {kernel.opcode}});
    Random random(1);
    double worst = 0, at = 0;
    for (int i = 0; i < 40000; ++i) {
      double x = std::exp(random.uniform(-30, 14)) * (random.chance(0.5) ? -1 : 1);
      if (kernel.limit <= 1) x = random.uniform(-1, 1);
      if (i % 4 == 0 && kernel.limit == 1e4) x = 1.5707963267948966 * random.below(600000);
      if (kernel.opcode == Opcode::Exp) x = random.uniform(-700, 700);
      const long double truth = kernel.long_truth(x);
      const double value = vm::evaluate_distance(program, glm::dvec3(x, 0, 0), workspace);
      if (std::isnan(truth)) {
        CHECK(std::isnan(value));
        continue;
      }
      const double off = static_cast<double>(std::abs(value - truth) / std::max(std::abs(truth), 1e-300L));
      if (off > worst) worst = off, at = x;
    }
    INFO(vm::info(kernel.opcode).mnemonic << ": " << worst << " at " << at);
    CHECK(worst <= 1e-14);
  }
}

TEST_CASE("sine and cosine of turns and degrees are within 1e-15, and exact at quarter turns",
          "[number][elementary]") {
  using vm::real::SinCos;
  const long double full = 2 * std::acos(-1.0L);
  const auto error = [&](SinCos angle, long double turns) {
    const long double x = full * (turns - std::round(turns));
    return static_cast<double>(std::max(std::abs(std::sin(x) - angle.sin), std::abs(std::cos(x) - angle.cos)));
  };
  double worst = 0;
  for (int i = -(1 << 18); i <= 1 << 19; ++i) {
    const double turns = i * 0x1p-18 + (i % 7) * 1e-9, degrees = i * 0.0037;
    worst = std::max(worst, error(vm::real::sin_cos_turns(turns), turns));
    worst = std::max(worst, error(vm::real::sin_cos_degrees(degrees), static_cast<long double>(degrees) / 360));
  }
  CHECK(worst <= 2e-16);
  for (int quarter = -8; quarter <= 8; ++quarter) {
    for (const SinCos angle : {vm::real::sin_cos_turns(quarter / 4.0), vm::real::sin_cos_degrees(quarter * 90.0)}) {
      CHECK(angle.sin == (quarter % 2 == 0 ? 0 : (quarter & 3) == 1 ? 1 : -1));
      CHECK(angle.cos == (quarter % 2 != 0 ? 0 : (quarter & 3) == 0 ? 1 : -1));
    }
  }
  CHECK(vm::real::sin_cos_degrees(36e17 + 1024).sin == vm::real::sin_cos_degrees(1024).sin);
}

TEST_CASE("atan2 and pow against libm", "[number][elementary]") {
  vm::Workspace workspace;
  const vm::VerifiedProgram angle = formula({{Opcode::X}, {Opcode::Y}, {Opcode::Atan2}});
  const vm::VerifiedProgram power = formula({{Opcode::X}, {Opcode::Y}, {Opcode::Power}});
  Random random(2);
  double worst_angle = 0, worst_power = 0, worst_double = 0;
  for (int i = 0; i < 100000; ++i) {
    const glm::vec3 p(std::exp(random.uniform(-20, 20)) * (random.chance(0.5) ? -1 : 1), random.uniform(-10, 10), 0);
    worst_angle = std::max(worst_angle, ulps(evaluate_float(angle, p, workspace), std::atan2(double(p.x), p.y)));
    const glm::vec3 q(std::abs(p.x), p.y, 0);
    const double truth = std::pow(double(q.x), q.y), arg = std::abs(q.y * std::log(double(q.x)));
    if (truth > 1e-37 && truth < 3e38) {
      worst_power = std::max(worst_power, ulps(evaluate_float(power, q, workspace), truth) / (2 + 2 * arg));
      const double doubles = vm::evaluate_distance(power, glm::dvec3(q), workspace);
      worst_double = std::max(worst_double, std::abs(doubles / truth - 1) / (1 + arg));
    }
  }
  INFO("atan2 " << worst_angle << " ulp; pow " << worst_power << " of (2 + 2 |y log x|) ulp; double "
                << worst_double);
  CHECK(worst_angle <= 4);
  CHECK(worst_power <= 1);
  CHECK(worst_double <= 1e-15);
}

TEST_CASE("elementary functions at the edges", "[number][elementary]") {
  for (Opcode opcode : {Opcode::Sin, Opcode::Cos, Opcode::Tan, Opcode::Exp, Opcode::Log, Opcode::Asin, Opcode::Acos,
                        Opcode::Atan, Opcode::Floor, Opcode::Ceil, Opcode::Nearest, Opcode::Sign, Opcode::Not}) {
    INFO(vm::info(opcode).mnemonic);
    CHECK(std::isnan(float_of(opcode, kNan)));
    CHECK(std::isnan(value_of(opcode, kNan)));
  }
  for (float x = 1e4f; x < kInf; x *= 1.37f) {
    for (Opcode opcode : {Opcode::Sin, Opcode::Cos}) {
      CHECK(std::abs(float_of(opcode, x)) <= 1);
      CHECK(std::abs(value_of(opcode, x)) <= 1);
    }
    CHECK_FALSE(std::isnan(float_of(Opcode::Tan, -x)));
  }
  CHECK(std::isnan(float_of(Opcode::Sin, kInf)));
  CHECK(float_of(Opcode::Exp, kInf) == kInf);
  CHECK(float_of(Opcode::Exp, -kInf) == 0);
  CHECK(float_of(Opcode::Exp, 89) == kInf);
  CHECK(float_of(Opcode::Exp, -104) == 0);
  CHECK(value_of(Opcode::Exp, 710) == kInf);
  CHECK(float_of(Opcode::Log, 0) == -kInf);
  CHECK(float_of(Opcode::Log, -0.f) == -kInf);
  CHECK(float_of(Opcode::Log, kInf) == kInf);
  CHECK(std::isnan(float_of(Opcode::Log, -1)));
  CHECK(float_of(Opcode::Asin, 7) == float_of(Opcode::Asin, 1));
  CHECK(float_of(Opcode::Acos, 7) == 0);
  CHECK(float_of(Opcode::Acos, -kInf) == float_of(Opcode::Acos, -1));
  CHECK(float_of(Opcode::Atan, kInf) == 1.57079632679f);
  CHECK(float_of(Opcode::Atan2, 0, 0) == 0);
  CHECK(float_of(Opcode::Atan2, 0, -1) == 3.14159265f);
  CHECK(float_of(Opcode::Atan2, kInf, kInf) == 0.785398163f);
  CHECK(float_of(Opcode::Atan2, -3, 0) == -1.57079632679f);
  const float halves[][4] = {
      {-1.5f, -2, -1, -2},          {-0.5f, -1, 0, 0},           {0.5f, 0, 1, 0}, {1.5f, 1, 2, 2}, {2.5f, 2, 3, 2},
      {1e30f, 1e30f, 1e30f, 1e30f}, {-kInf, -kInf, -kInf, -kInf}};
  for (const auto& row : halves) {
    INFO(row[0]);
    CHECK(float_of(Opcode::Floor, row[0]) == row[1]);
    CHECK(float_of(Opcode::Ceil, row[0]) == row[2]);
    CHECK(float_of(Opcode::Nearest, row[0]) == row[3]);
    CHECK(value_of(Opcode::Floor, row[0]) == row[1]);
    CHECK(value_of(Opcode::Ceil, row[0]) == row[2]);
    CHECK(value_of(Opcode::Nearest, row[0]) == row[3]);
  }
}

TEST_CASE("binary mathematics by its table", "[number][elementary]") {
  struct Row {
    Opcode opcode;
    float a, b, result;
  };
  const Row rows[] = {
      {Opcode::Add, 1, 2, 3},
      {Opcode::Minus, 1, 2, -1},
      {Opcode::Multiply, 3, -2, -6},
      {Opcode::Divide, 1, 4, 0.25f},
      {Opcode::Divide, 1, 0, kInf},
      {Opcode::Modulo, 7, 3, 1},
      {Opcode::Modulo, -7, 3, 2},
      {Opcode::Modulo, 7, -3, -2},
      {Opcode::Modulo, 1, 0, kNan},
      {Opcode::ModuloEuclid, 7, -3, 1},
      {Opcode::ModuloEuclid, -7, -3, 2},
      {Opcode::Power, -2, 3, -8},
      {Opcode::Power, -2, 2, 4},
      {Opcode::Power, -2, 0.5f, kNan},
      {Opcode::Power, 0, 2, 0},
      {Opcode::Power, 0, 0, 1},
      {Opcode::Power, 0, -1, kInf},
      {Opcode::Power, 5, 0, 1},
      {Opcode::Compare, 1, 2, -1},
      {Opcode::Compare, 2, 2, 0},
      {Opcode::Compare, 3, 2, 1},
      {Opcode::Compare, kNan, 2, kNan},
      {Opcode::Compare, 2, kNan, kNan},
      {Opcode::And, 0, 5, 0},
      {Opcode::And, 2, 5, 5},
      {Opcode::Or, 0, 5, 5},
      {Opcode::Or, 2, 5, 2},
      {Opcode::Or, -2, 5, -2},
      {Opcode::Step, 1, 0.5f, 0},
      {Opcode::Step, 1, 1, 1},
      {Opcode::Step, 1, 2, 1},
      {Opcode::Step, 1, kNan, kNan},
  };
  vm::Workspace workspace;
  for (const Row& row : rows) {
    INFO(vm::info(row.opcode).mnemonic << ' ' << row.a << ' ' << row.b);
    const float tolerance = row.opcode == Opcode::Power ? 1e-6f : 0;
    const float value = float_of(row.opcode, row.a, row.b);
    CHECK((same(value, row.result) || std::abs(value - row.result) <= tolerance * std::abs(row.result)));
    const auto program = formula({{Opcode::X}, {Opcode::Y}, {row.opcode}});
    const double doubles = vm::evaluate_distance(program, glm::dvec3(row.a, row.b, 0), workspace);
    CHECK((same(float(doubles), row.result) || std::abs(doubles - row.result) <= tolerance * std::abs(row.result)));
  }
}

}  // namespace fathom::test::elementary_test
