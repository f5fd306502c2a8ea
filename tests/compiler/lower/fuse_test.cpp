// Fused programs have the same bits as plain ones on every evaluator, and leave nothing to fuse.
#include "compiler/lower/fuse.h"

#include <bit>
#include <string>

#include "compiler/lower/lower.h"
#include "tests/support/catch.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "tests/vm/interpret/formula.h"
#include "vm/encoding/disassemble.h"
#include "vm/interpret/evaluate.h"
#include "vm/range/slope.h"

namespace fathom::test::fuse_test {
namespace {

using glm::dvec3;
using vm::Opcode;

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }
std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

// All NaNs count as equal: the processor decides which of two NaN operands a sum returns.
template <class Number>
bool same(Number a, Number b) {
  return bits(a) == bits(b) || (std::isnan(a) && std::isnan(b));
}

// Compares distance and surface of many points in float, then distance, surface, range and slope bound in double.
void check_same(const vm::VerifiedProgram& plain, const vm::VerifiedProgram& fused, Random& random) {
  constexpr std::size_t kPoints = 150;
  vm::Workspace workspace;
  std::vector<float> x(kPoints), y(kPoints), z(kPoints), a(kPoints), b(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const dvec3 p = random.in_box(i % 2 ? 8 : 2);
    x[i] = static_cast<float>(p.x), y[i] = static_cast<float>(p.y), z[i] = static_cast<float>(p.z);
  }
  const vm::Points points{x.data(), y.data(), z.data()};
  vm::evaluate_distance(plain, points, kPoints, a.data(), workspace);
  vm::evaluate_distance(fused, points, kPoints, b.data(), workspace);
  for (std::size_t i = 0; i < kPoints; ++i) REQUIRE(same(a[i], b[i]));

  std::vector<float> d[2], gx[2], gy[2], gz[2];
  std::vector<std::uint32_t> surface[2];
  for (int which = 0; which < 2; ++which) {
    for (auto* part : {&d[which], &gx[which], &gy[which], &gz[which]}) part->resize(kPoints);
    surface[which].resize(kPoints);
    vm::evaluate_surface(
        which ? fused : plain, points, kPoints,
        {d[which].data(), gx[which].data(), gy[which].data(), gz[which].data(), surface[which].data()}, workspace);
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    REQUIRE(same(d[0][i], d[1][i]));
    REQUIRE((same(gx[0][i], gx[1][i]) && same(gy[0][i], gy[1][i]) && same(gz[0][i], gz[1][i])));
    REQUIRE(surface[0][i] == surface[1][i]);
  }

  for (int i = 0; i < 10; ++i) {
    const dvec3 p = random.in_box(4), size(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    REQUIRE(same(vm::evaluate_distance(plain, p, workspace), vm::evaluate_distance(fused, p, workspace)));
    const vm::SurfaceValue u = vm::evaluate_surface(plain, p, workspace);
    const vm::SurfaceValue v = vm::evaluate_surface(fused, p, workspace);
    REQUIRE((same(u.distance, v.distance) && u.surface == v.surface));
    for (int axis = 0; axis < 3; ++axis) REQUIRE(same(u.gradient[axis], v.gradient[axis]));
    const vm::Range r = vm::evaluate_range(plain, p, p + size, workspace);
    const vm::Range s = vm::evaluate_range(fused, p, p + size, workspace);
    REQUIRE((same(r.lo, s.lo) && same(r.hi, s.hi)));
    const vm::SlopeBound f = vm::evaluate_slope(plain, p, p + size, workspace);
    const vm::SlopeBound g = vm::evaluate_slope(fused, p, p + size, workspace);
    REQUIRE((same(f.lipschitz, g.lipschitz) && same(f.float_error, g.float_error)));
  }
}

// The listing without heading, offsets and stack heights: one operation per line.
std::string operations(const vm::VerifiedProgram& program) {
  std::string all;
  const std::string text = vm::disassemble(program);
  constexpr std::size_t kColumn = 37;
  for (std::size_t at = text.find("\n  ") + 1; at < text.size(); at = text.find('\n', at) + 1) {
    const std::string line = text.substr(at, text.find('\n', at) - at);
    const std::string operation = line.substr(kColumn, line.find(" @") - kColumn);
    all += operation.substr(0, operation.find_last_not_of(' ') + 1) + '\n';
  }
  return all;
}

struct Instruction {
  Opcode opcode;
  std::vector<double> immediates = {};
  std::uint32_t operand = 0;
};

std::string fused(const std::vector<Instruction>& instructions) {
  vm::Program program;
  program.locals = 2;
  for (const Instruction& i : instructions) program.append(i.opcode, i.operand, i.immediates, {});
  const vm::VerifiedProgram plain = verified(program), result = verified(compiler::fuse(program));
  Random random(1);
  check_same(plain, result, random);
  return operations(result);
}

}  // namespace

TEST_CASE("a shape takes in its translate, drop and min", "[lower][fuse]") {
  const Instruction move{Opcode::Translate, {1, 2, 3}}, drop{Opcode::Drop}, ball{Opcode::Sphere, {0.5}},
      box{Opcode::Box, {1, 2, 3}}, least{Opcode::Min};
  CHECK(fused({move, ball, drop}) == "sphere 0.5 at 1 2 3\n");
  CHECK(fused({move, ball, drop, box, least}) == "sphere 0.5 at 1 2 3\nbox 1 2 3 min\n");
  CHECK(fused({box, move, ball, drop, least}) == "box 1 2 3\nsphere 0.5 at 1 2 3 min\n");
  CHECK(fused({move, ball, box, least, drop}) == "translate 1 2 3\nsphere 0.5\nbox 1 2 3 min\ndrop\n");
  CHECK(fused({move, move, ball, drop, drop}) == "translate 1 2 3\nsphere 0.5 at 1 2 3\ndrop\n");
  CHECK(fused({box, move, {Opcode::Mandelbulb, {8, 4, 2, 1.2, 0}}, drop, least}) ==
        "box 1 2 3\nmandelbulb 8 4 2 1.2 0 at 1 2 3 min\n");
  CHECK(fused({ball, box, {Opcode::Max}}) == "sphere 0.5\nbox 1 2 3\nmax\n");
  CHECK(fused({ball, {Opcode::Polygon, {0, 0, 1, 0, 0, 1}}, least}) == "sphere 0.5\npolygon 3  0 0  1 0  0 1\nmin\n");
}

TEST_CASE("functions take coordinates, constants and locals for operands", "[lower][fuse]") {
  const Instruction x{Opcode::X}, y{Opcode::Y}, z{Opcode::Z}, two{Opcode::Constant, {2}},
      three{Opcode::Constant, {3}}, minus{Opcode::Minus}, sine{Opcode::Sin}, ball{Opcode::Sphere, {0.5}},
      tee{Opcode::Tee, {}, 1}, load{Opcode::Load, {}, 1}, least{Opcode::Min};
  CHECK(fused({x, sine}) == "sin x\n");
  CHECK(fused({x, y, minus}) == "minus x y\n");
  CHECK(fused({two, z, minus}) == "minus 2 z\n");
  CHECK(fused({two, three, minus}) == "minus 2 3\n");
  CHECK(fused({ball, x, minus}) == "sphere 0.5\nminus _ x\n");
  CHECK(fused({ball, two, minus, x, {Opcode::Multiply}}) == "sphere 0.5\nminus _ 2\nmultiply _ x\n");
  CHECK(fused({x, ball, minus}) == "x\nsphere 0.5\nminus\n");
  CHECK(fused({ball, tee, load, minus}) == "sphere 0.5\ntee 1\nminus _ %1\n");
  CHECK(fused({ball, tee, x, sine, load, minus, {Opcode::Max}}) == "sphere 0.5\ntee 1\nsin x\nminus _ %1\nmax\n");
  CHECK(fused({ball, tee, load, load, minus, least}) == "sphere 0.5\ntee 1\nminus %1 %1\nmin\n");
  CHECK(fused({ball, tee, load, two, minus, least}) == "sphere 0.5\ntee 1\nminus %1 2\nmin\n");
  CHECK(fused({ball, x, least}) == "sphere 0.5\nmin _ x\n");
  CHECK(fused({ball, {Opcode::Translate, {1, 0, 0}}, x, sine, {Opcode::Drop}, least}) ==
        "sphere 0.5\ntranslate 1 0 0\nsin x\ndrop\nmin\n");
  CHECK(fused({ball, two, {Opcode::SmoothMin, {0.5, 0.5}}}) == "sphere 0.5\nsmooth_min _ 2 0.5 0.5\n");
  // Two locals, of which an instruction's operand can name one.
  CHECK(fused({ball, {Opcode::Tee, {}, 0}, x, sine, tee, minus, {Opcode::Load, {}, 0}, load, minus, least}) ==
        "sphere 0.5\ntee 0\nsin x\ntee 1\nminus\nload 0\nminus _ %1\nmin\n");
}

TEST_CASE("fused programs have the bits of plain ones", "[lower][fuse]") {
  for (int seed = 0; seed < scaled_cases(400); ++seed) {
    Random random(seed);
    GraphOptions options;
    options.depth = 2 + static_cast<int>(seed % 4);
    options.mandelbulbs = seed % 2 == 0;
    const compiler::Scene scene = random_scene(random, options);
    const auto plain = compiler::lower(scene, compiler::Source("", ""), 1'000'000);
    REQUIRE(plain);
    const vm::Program once = compiler::fuse(*plain);
    INFO("seed " << seed);
    check_same(verified(*plain), verified(once), random);
    CHECK(once.words.size() <= plain->words.size());
    CHECK(compiler::fuse(once).words == once.words);
    // Every instruction keeps its source location.
    REQUIRE(once.debug.size() == verified(once).instructions());
  }
  for (int seed = 0; seed < scaled_cases(1000); ++seed) {
    const vm::VerifiedProgram plain = formula(random_formula(seed));
    Random random(seed);
    INFO("formula, seed " << seed);
    check_same(plain, verified(compiler::fuse(plain.program())), random);
  }
}

}  // namespace fathom::test::fuse_test
