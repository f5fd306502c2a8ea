// Tests of the shares of surfaces where blends mix them.
#include <cmath>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "vm/interpret/evaluate.h"

namespace fathom::vm::shares_test {
namespace {

compiler::CompiledScene blend_of(const std::string& combinator) {
  return test::compiled(R"({"version": 1,
      "materials": {"a": {"type": "diffuse"}, "b": {"type": "specular"}, "c": {"type": "transparent"}},
      "objects": [{)" + combinator +
                        R"(, "of": [{"type": "sphere", "radius": 1, "material": "a"},
        {"type": "sphere", "radius": 1, "translate": [1.5, 0, 0], "material": "b"}]},
        {"type": "sphere", "radius": 1, "translate": [9, 0, 0], "material": "c"}]})");
}

// One digit per surface: 1 if a blend mixes the surface.
std::string mixed(const compiler::CompiledScene& scene) {
  std::string digits;
  for (const compiler::Surface& surface : scene.surfaces) digits += surface.mixed ? '1' : '0';
  return digits;
}

double share_of(const compiler::CompiledScene& scene, const char* material, glm::dvec3 place) {
  Workspace workspace;
  const SurfaceShares shares = evaluate_shares(scene.surface, place, workspace);
  double sum = 0, share = 0;
  for (int i = 0; i < shares.count; ++i) {
    const SurfaceShare& one = shares.all[static_cast<std::size_t>(i)];
    sum += one.weight;
    if (scene.materials[scene.surfaces[one.surface].material].name == material) share += one.weight;
  }
  CHECK(sum == Approx(1).epsilon(1e-12));
  return share;
}

TEST_CASE("shares: along a smooth blend they are Quilez's mix factor", "[interpret]") {
  const auto scene = blend_of(R"("type": "smooth_union", "k": 0.6)");
  CHECK(mixed(scene) == "110");
  for (double x = -1.5; x < 3; x += 0.0625) {
    const glm::dvec3 p(x, 0.9, 0.1);
    const double a = std::sqrt(x * x + 0.82) - 1, b = std::sqrt((x - 1.5) * (x - 1.5) + 0.82) - 1;
    const double h = std::max(0.6 - std::abs(a - b), 0.0) / 0.6, loser = h / 2;
    INFO("x " << x);
    CHECK(share_of(scene, "a", p) == Approx(a < b ? 1 - loser : loser).margin(1e-9));
    CHECK(share_of(scene, "c", p) == 0);
  }
}

TEST_CASE("shares: far from a blend, and in a plain union, one surface has all", "[interpret]") {
  for (const char* combinator :
       {R"("type": "union")", R"("type": "smooth_union", "k": 0.2)", R"("type": "round_union", "radius": 0.1)",
        R"("type": "chamfer_union", "radius": 0.1)"}) {
    const auto scene = blend_of(combinator);
    CHECK(share_of(scene, "a", {-1, 0, 0}) == 1);
    CHECK(share_of(scene, "b", {2.5, 0, 0}) == 1);
    CHECK(share_of(scene, "c", {8, 0, 0}) == 1);
  }
  CHECK(mixed(blend_of(R"("type": "union")")) == "000");
}

TEST_CASE("shares: what a blend mixes is known, also where a part has its material from above", "[interpret]") {
  const auto scene = test::compiled(R"({"version": 1,
      "materials": {"a": {"type": "diffuse"}, "b": {"type": "specular"}},
      "objects": [{"type": "smooth_union", "k": 0.5, "material": "a", "of": [{"type": "sphere", "radius": 1},
          {"type": "sphere", "radius": 1, "translate": [1.5, 0, 0], "material": "b"}]},
        {"type": "smooth_union", "k": 0.5, "material": "a", "of": [{"type": "sphere", "radius": 1, "translate": [5, 0, 0]},
          {"type": "sphere", "radius": 1, "translate": [6, 0, 0], "material": "a"}]}]})");
  CHECK(mixed(scene) == "110");
  CHECK(share_of(scene, "b", {0.75, 0.9, 0}) == Approx(0.5));
}

TEST_CASE("shares: halfway between two of one shape each has half, whatever joins them", "[interpret]") {
  for (const char* combinator : {R"("type": "smooth_union", "k": 0.5)", R"("type": "round_union", "radius": 0.5)",
                                 R"("type": "morph", "t": 0.5)"}) {
    INFO(combinator);
    const auto scene = blend_of(combinator);
    CHECK(share_of(scene, "a", {0.75, 0.7, 0}) == Approx(0.5).epsilon(1e-9));
  }
}

TEST_CASE("shares: a chamfer is of both, in equal parts", "[interpret]") {
  const auto scene = blend_of(R"("type": "chamfer_union", "radius": 0.4)");
  CHECK(share_of(scene, "a", {0.74, 0.7, 0}) == Approx(0.5).epsilon(1e-9));
  CHECK(share_of(scene, "a", {0.76, 0.7, 0}) == Approx(0.5).epsilon(1e-9));
}

TEST_CASE("shares: a cut shows the material of what cuts", "[interpret]") {
  const auto scene = blend_of(R"("type": "smooth_subtraction", "k": 0.1)");
  CHECK(share_of(scene, "b", {0.5, 0, 0}) == 1);
  CHECK(share_of(scene, "a", {-1, 0, 0}) == 1);
}

}  // namespace
}  // namespace fathom::vm::shares_test
