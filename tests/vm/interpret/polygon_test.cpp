// Compares the polygon opcode with brute force, and checks the rules of instructions with a variable number of
// immediates.
#include <cmath>

#include "tests/support/catch.h"
#include "tests/vm/interpret/formula.h"
#include "vm/encoding/disassemble.h"
#include "vm/range/slope.h"

namespace fathom::test::polygon_test {
namespace {

using glm::dvec2;
using glm::dvec3;
using vm::Opcode;

// Star-shaped polygon: corners at increasing angles, so that the polygon is simple.
std::vector<double> star(Random& random, int corners, bool clockwise) {
  std::vector<double> xy;
  for (int i = 0; i < corners; ++i) {
    const double angle = 6.283185307179586 * (clockwise ? -i : i) / corners, radius = random.uniform(0.3, 2);
    xy.push_back(static_cast<float>(radius * std::cos(angle)));
    xy.push_back(static_cast<float>(radius * std::sin(angle)));
  }
  return xy;
}

// Distance to the nearest point over all edges; inside by the winding angle.
double brute_force(const std::vector<double>& xy, dvec2 p) {
  const std::size_t n = xy.size() / 2;
  double nearest = 1e300, winding = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const dvec2 a(xy[2 * i], xy[2 * i + 1]), b(xy[2 * ((i + 1) % n)], xy[2 * ((i + 1) % n) + 1]);
    const double t = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    nearest = std::min(nearest, glm::length(p - (a + t * (b - a))));
    const dvec2 u = a - p, v = b - p;
    winding += std::atan2(u.x * v.y - u.y * v.x, glm::dot(u, v));
  }
  return std::abs(winding) > 1 ? -nearest : nearest;
}

vm::Program polygon_code(const std::vector<double>& xy) {
  vm::Program code;
  code.append(Opcode::Polygon, 0, xy, {});
  return code;
}
std::string refusal(vm::Program code) {
  const auto result = vm::verify(std::move(code));
  const auto* error = std::get_if<vm::VerifyError>(&result);
  return error ? error->reason : "";
}

}  // namespace

TEST_CASE("a polygon is its exact distance, with a unit gradient", "[interpret][polygon]") {
  vm::Workspace workspace;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const auto xy = star(random, 3 + random.below(12), seed % 2 == 0);
    const vm::VerifiedProgram program = verified(polygon_code(xy));
    for (int i = 0; i < 200; ++i) {
      const glm::vec3 p(random.uniform(-3, 3),
                        random.chance(0.2) ? xy[1 + 2 * std::size_t(random.below(3))] : random.uniform(-3, 3),
                        random.uniform(-9, 9));
      const double truth = brute_force(xy, dvec2(p.x, p.y));
      INFO("seed " << seed << " at " << p.x << ' ' << p.y << ": " << truth);
      const vm::SurfaceValue doubles = vm::evaluate_surface(program, dvec3(p), workspace);
      CHECK(std::abs(doubles.distance - truth) <= 1e-14);
      CHECK(std::abs(glm::length(doubles.gradient) - 1) <= 1e-9);
      CHECK(std::abs(evaluate_float(program, p, workspace) - truth) <= 10 * 0x1p-24 * 4);
    }
    for (std::size_t i = 0; i < xy.size() / 2; ++i) {  // on the outline
      const std::size_t j = (i + 1) % (xy.size() / 2);
      const dvec2 a(xy[2 * i], xy[2 * i + 1]), b(xy[2 * j], xy[2 * j + 1]), m = (a + b) / 2.0;
      const vm::SurfaceValue on = vm::evaluate_surface(program, dvec3(m, 0), workspace);
      const dvec2 outward = (seed % 2 == 0 ? -1.0 : 1.0) * dvec2(b.y - a.y, a.x - b.x) / glm::length(b - a);
      CHECK(std::abs(on.distance) <= 1e-15);
      CHECK(glm::length(dvec2(on.gradient.x, on.gradient.y) - outward) <= 1e-9);
    }
    for (int box = 0; box < 20; ++box) {
      const dvec3 lo = random.in_box(3), hi = lo + random.uniform(0, 1);
      const vm::Range range = vm::evaluate_range(program, lo, hi, workspace);
      const vm::SlopeBound slope = vm::evaluate_slope(program, lo, hi, workspace);
      CHECK(slope.lipschitz <= 1 + 1e-9);
      for (int i = 0; i < 10; ++i) {
        const dvec3 p(random.uniform(lo.x, hi.x), random.uniform(lo.y, hi.y), 0);
        const double value = vm::evaluate_distance(program, p, workspace);
        CHECK((range.lo <= value && value <= range.hi));
      }
    }
  }
}

TEST_CASE("a polygon in sheared space changes as fast as its points move", "[interpret][polygon][slope]") {
  vm::Workspace workspace;
  const std::vector<double> triangle = {1, 0, -1, 1, -1, -1};
  const double shears[] = {0.5, 1, -2};
  for (const double shear : shears) {
    vm::Program code;
    code.append(Opcode::Affine, 0, std::vector<double>{1, shear, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, {});
    code.append(Opcode::Polygon, 0, triangle, {});
    code.append(Opcode::Drop, 0, {}, {});
    const vm::VerifiedProgram program = verified(std::move(code));
    Random random(7);
    for (int box = 0; box < 200; ++box) {
      const dvec3 lo = random.in_box(3), hi = lo + 1e-3;
      const vm::SlopeBound slope = vm::evaluate_slope(program, lo, hi, workspace);
      const vm::SurfaceValue at = vm::evaluate_surface(program, (lo + hi) / 2.0, workspace);
      INFO("shear " << shear << " at " << lo.x << ' ' << lo.y);
      CHECK(glm::length(at.gradient) <= slope.lipschitz * (1 + 1e-9));
      CHECK(slope.lipschitz <= 2 + std::abs(shear));
    }
  }
}

TEST_CASE("an outline has whole groups, enough of them, all finite", "[interpret][polygon][verify]") {
  const std::vector<double> triangle = {0, 0, 1, 0, 0, 1};
  const vm::VerifiedProgram program = verified(polygon_code(triangle));
  CHECK(program.cost() == 3u * static_cast<unsigned>(vm::info(Opcode::Polygon).cost));
  CHECK(vm::instruction_length(program.program().words[0]) == 7);
  CHECK(vm::disassemble(program).find("polygon 3  0 0  1 0  0 1") != std::string::npos);
  CHECK(refusal(polygon_code({0, 0, 1, 0})).find("at least 3") != std::string::npos);
  CHECK(refusal(polygon_code({})).find("at least 3") != std::string::npos);
  vm::Program cut = polygon_code(triangle);
  cut.words.pop_back(), cut.doubles.pop_back();
  CHECK(refusal(cut).find("cut off") != std::string::npos);
  vm::Program huge = polygon_code(triangle);
  huge.words[0] = vm::opcode_word(Opcode::Polygon, vm::kMaxOperand);
  CHECK(refusal(huge).find("cut off") != std::string::npos);
  CHECK(refusal(polygon_code({0, 0, 1, 0, 0, 1e39})).find("y is not finite") != std::string::npos);
  vm::Program differs = polygon_code(triangle);
  differs.doubles[5] = 0.5;
  CHECK(refusal(differs).find("wide table") != std::string::npos);
}

}  // namespace fathom::test::polygon_test
