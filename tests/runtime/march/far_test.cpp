// Scenes far from zero, and small objects next to large ones: hits are as exact as near zero
// (compiler/analysis/origin.h).
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "runtime/march/march.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"

namespace fathom::runtime::far_test {
namespace {

// Moves the rays by `offset`. They stay exact in float and aim at the solid. Moving them back is exact and gives the
// truth.
std::vector<Ray> rays_far_off(const std::vector<Ray>& here, double offset) {
  std::vector<Ray> there = here;
  for (Ray& ray : there) ray.origin = to_float(ray.origin + glm::dvec3(offset, 0, 0));
  return there;
}

TEST_CASE("march: far from the scene's zero hits are as exact as near it", "[march]") {
  struct Case {
    const char* solid;
    Truth truth;
    double miss;  // max distance of rays from the solid's centre
  };
  const Case cases[] = {
      {R"("type": "sphere", "radius": 1)", sphere_distance, 1},
      {R"("type": "box", "half_size": [0.75, 0.5, 1])", box_distance, 0.5},
      {R"("type": "torus", "major_radius": 1, "minor_radius": 0.25)", torus_distance, 1.25},
  };
  for (const Case& c : cases) {
    Random random(9);
    std::vector<Ray> aims;
    for (int i = 0; i < 2000; ++i) aims.push_back(aimed(random, c.miss * std::sqrt(random.uniform(0, 1)), 5));
    double certified_here = 0;
    for (const double offset : {0.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
      const auto scene = scene_of(std::string(R"("objects": [{)") + c.solid + R"(, "translate": [)" +
                                  std::to_string(offset) + ", 0, 0]}]");
      std::vector<Ray> local = rays_far_off(aims, offset), back = local;
      for (Ray& ray : local) ray.origin -= scene.origin;
      for (Ray& ray : back) ray.origin.x -= offset;
      const MarchResult result = march(make_field(scene), local);
      const Judgement judgement = judge(result, back, c.truth);
      INFO(c.solid << " at " << offset << ": p99 " << judgement.p99() << ", worst " << judgement.worst() << ", "
                   << result.counters.certified << " of " << aims.size() << " decided in double");
      REQUIRE(judgement.errors.size() > aims.size() / 4);
      CHECK(judgement.false_hits + judgement.false_misses == 0);
      CHECK(judgement.invalid == 0);
      // Size of the coordinates in which rays are marched. Only at offset 10 are they further from zero than the
      // solid is wide.
      const float size = static_cast<float>(offset - scene.origin.x + 1);
      const double unit = static_cast<double>(std::nextafter(size, INFINITY) - size);
      CHECK(judgement.p99() <= std::max(2e-6, 4 * unit));
      CHECK(judgement.worst() <= 1e-4);
      if (offset == 0) certified_here = static_cast<double>(result.counters.certified);
      CHECK(static_cast<double>(result.counters.certified) <=
            certified_here + 1e-2 * static_cast<double>(aims.size()));
      CHECK(result.counters.exhausted == 0);
    }
  }
}

TEST_CASE("march: over an endless floor far off, a ball is met where it is", "[march]") {
  for (const double offset : {0.0, 1e5, 1e6}) {
    const std::string x = std::to_string(offset);
    const auto scene = scene_of(R"("camera": {"position": [)" + x + R"(, 2, 6], "target": [)" + x + R"(, 0, 0]},
        "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
                    {"type": "sphere", "radius": 1, "translate": [)" +
                                x + ", 0, 0]}]");
    Random random(10);
    std::vector<Ray> back, local;
    for (int i = 0; i < 4000; ++i) {
      const glm::dvec3 at(random.uniform(-3, 3), -1, random.uniform(-3, 3));
      back.push_back({{0, 2, 6}, to_float(glm::normalize(at - glm::dvec3(0, 2, 6)))});
      local.push_back({back.back().origin + glm::dvec3(offset, 0, 0) - scene.origin, back.back().direction});
    }
    const MarchResult result = march(make_field(scene), local);
    const Judgement judgement = judge(result, back, [](const Ray& ray) {
      const Real ball = sphere_distance(ray), floor = (-1 - static_cast<Real>(ray.origin.y)) / ray.direction.y;
      return ball >= 0 ? std::min(ball, floor) : floor;
    });
    INFO(offset << ": p99 " << judgement.p99() << ", " << result.counters.certified << " decided in double");
    CHECK(judgement.errors.size() == back.size());
    CHECK(judgement.p99() <= 2e-6);
    CHECK(result.counters.certified <= 20);
    CHECK(result.counters.exhausted + result.counters.invalid == 0);
  }
}

// A ball ten thousand times smaller than its neighbour.
TEST_CASE("march: a grain beside a ball is hit where it is", "[march]") {
  for (const double away : {1e-3, 1e-2, 1e-1}) {
    const std::string camera =
        R"("camera": {"position": [1.001, 0, )" + std::to_string(away) + R"(], "target": [1.001, 0, 0]}, )";
    const auto scene = scene_of(camera + R"("objects": [{"type": "sphere", "radius": 1},
        {"type": "sphere", "radius": 1e-4, "translate": [1.0009765625, 0, 0]}])");
    Random random(11);
    const Real r = static_cast<Real>(1e-4), x = 1.0009765625L;
    std::vector<Ray> rays;
    for (int i = 0; i < 2000; ++i) {
      const double angle = random.uniform(0, 2 * M_PI), miss = 0.99e-4 * std::sqrt(random.uniform(0, 1));
      rays.push_back({to_float({1.0009765625 + miss * std::cos(angle), miss * std::sin(angle), away}), {0, 0, -1}});
    }
    std::vector<Ray> local = rays;
    for (Ray& ray : local) ray.origin -= scene.origin;
    const MarchResult result = march(make_field(scene), local);
    std::vector<double> errors;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Real dx = rays[i].origin.x - x, dy = rays[i].origin.y,
                 t = rays[i].origin.z - std::sqrt(r * r - dx * dx - dy * dy);
      if (result.ray_hits[i].status == RayHit::Status::Hit)
        errors.push_back(static_cast<double>(std::abs(result.ray_hits[i].t - t) / t));
    }
    std::sort(errors.begin(), errors.end());
    INFO("from " << away << ": p99 " << errors[errors.size() * 99 / 100] << ", worst " << errors.back() << ", "
                 << result.counters.certified << " in double");
    CHECK(errors.size() == rays.size());
    CHECK(errors[errors.size() * 99 / 100] <= 1e-6);
    CHECK(result.counters.exhausted == 0);
  }
}

}  // namespace
}  // namespace fathom::runtime::far_test
