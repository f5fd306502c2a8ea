// The adversarial catalogue, row F4: repeated balls compared with the same balls in a list. Jittered copies:
// warps_test.cpp.
#include <cmath>
#include <string>
#include <vector>

#include "tests/catalogue/closed_forms.h"
#include "tests/catalogue/naive.h"
#include "tests/support/catch.h"

namespace fathom::catalogue::copies_test {
namespace {

// Balls at all integer points from -reach to reach along each axis.
Truth balls(int reach, Real radius) {
  return [=](const Ray& ray) {
    Real first = -1;
    for (int i = -reach; i <= reach; ++i) {
      for (int j = -reach; j <= reach; ++j) {
        for (int k = -reach; k <= reach; ++k) first = nearer(first, entry(sphere_span(ray, {i, j, k}, radius)));
      }
    }
    return first <= ray.t_max ? first : -1;
  };
}

std::string repeated(const char* count, const char* radius) {
  return std::string(R"("objects": [{"type": "repetition", "period": [1, 1, 1], "count": )") + count +
         R"(, "of": {"type": "sphere", "radius": )" + radius + "}}]";
}

void expect_copies(const std::string& scene_text, const std::vector<Ray>& rays, const Truth& truth) {
  const auto scene = scene_of(scene_text);
  CHECK(scene.certified);
  const Judgement found = judge(march(make_field(scene), rays), rays, truth);
  CHECK(found.wrong() == 0);
  CHECK(found.exhausted == 0);
  if (found.errors.empty()) return;
  CHECK(found.p99() <= 5e-6);
  CHECK(found.worst() <= 1e-4);
}

std::vector<Ray> rays_at_the_middle(int count, double spread, double away) {
  Random random(4);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back(aimed(random, spread * random.uniform(0, 1), away));
  return rays;
}

}  // namespace

TEST_CASE("F4: copies that end", "[catalogue]") {
  expect_copies(repeated("[3, 3, 3]", "0.25"), rays_at_the_middle(20000, 2, 6), balls(1, 0.25));
}

// The ball extends beyond its cell.
TEST_CASE("F4: copies larger than their cells", "[catalogue]") {
  const std::vector<Ray> rays = rays_at_the_middle(20000, 2, 6);
  expect_copies(repeated("[3, 3, 3]", "0.75"), rays, balls(1, 0.75));
  expect_copies(repeated("[5, 5, 5]", "0.625"), rays_at_the_middle(10000, 3, 8), balls(2, 0.625));
}

// Rays in the plane between two cells, where the copies on both sides are equally near.
TEST_CASE("F4: rays along the walls of cells", "[catalogue]") {
  Random random(5);
  std::vector<Ray> between, through;
  for (int i = 0; i < 5000; ++i) {
    const double turn = random.uniform(0, 2 * M_PI);
    const glm::dvec3 from(0.5, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    const glm::dvec3 d = to_float({0, std::cos(turn), std::sin(turn)});
    between.push_back({to_float(from), d, 6});
    through.push_back({to_float(from - 6.0 * d), d, 12});
  }
  expect_copies(repeated("[0, 0, 0]", "0.375"), between, [](const Ray&) { return Real(-1); });
  expect_copies(repeated("[3, 3, 3]", "0.75"), through, balls(1, 0.75));
}

TEST_CASE("F4: copies without end", "[catalogue]") {
  Random random(6);
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) rays.push_back({{0.5, 0.5, 0.5}, to_float(random.direction()), 6});
  expect_copies(repeated("[0, 0, 0]", "0.125"), rays, balls(8, 0.125));
}

}  // namespace fathom::catalogue::copies_test
