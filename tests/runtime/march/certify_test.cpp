#include "runtime/march/certify.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/march/march.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/vm/number/float_bits.h"

namespace fathom::runtime::certify_test {
namespace {

using Status = RayHit::Status;

TEST_CASE("certify: first roots of a sphere, from outside and from within", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field field = make_field(scene);
  RealScratch scratch;
  const CertifiedResult outside = certify(field, {0.5, 0, 5}, {0, 0, -1}, 1, {0, 10, 0}, scratch);
  CHECK(outside.status == Status::Hit);
  CHECK(std::abs(outside.t - (5 - std::sqrt(0.75))) <= 1e-12);
  CHECK(outside.width <= 1e-12);
  const CertifiedResult inside = certify(field, {0.5, 0, 0}, {0, 0, -1}, -1, {0, 10, 0}, scratch);
  CHECK(inside.status == Status::Hit);
  CHECK(std::abs(inside.t - std::sqrt(0.75)) <= 1e-12);
  CHECK(certify(field, {1.001, 0, 5}, {0, 0, -1}, 1, {0, 10, 0}, scratch).status == Status::Miss);
}

TEST_CASE("certify: the end of the segment counts", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field field = make_field(scene);
  RealScratch scratch;
  CHECK(certify(field, {0, 0, 5}, {0, 0, -1}, 1, {0, 3.999, 0}, scratch).status == Status::Miss);
  CHECK(certify(field, {0, 0, 5}, {0, 0, -1}, 1, {0, 4.001, 0}, scratch).status == Status::Hit);
}

// Regression: the end of the segment lay where the root of a negative number has no value, and the ray was invalid.
TEST_CASE("certify: a surface before a place without a value is found", "[march]") {
  const auto scene =
      scene_of(R"_("objects": [{"type": "expression", "formula": "y - sqrt(x)", "half_size": [2, 2, 2]}])_");
  const Field field = make_field(scene);
  RealScratch scratch;
  for (const double drop : {0.25, 0.5, 1.4, 2.0}) {
    CAPTURE(drop);
    // From (1, 1.5) down into x < 0, where y is 1.5 - drop at x = 0.
    const glm::dvec3 from(1, 1.5, 0.3), direction = glm::normalize(glm::dvec3(-1, -drop, 0));
    const CertifiedResult found = certify(field, from, direction, 1, {0, 1.7, 0}, scratch);
    const glm::dvec3 hit = from + found.t * direction;
    if (drop > 1.25) {
      CHECK(found.status == Status::Hit);
      CHECK(hit.y == Approx(std::sqrt(hit.x)).epsilon(1e-8));
    } else {
      CHECK(found.status == Status::Invalid);  // comes to x = 0 above the curve
    }
  }
}

TEST_CASE("certify: a touch without a crossing is a contact", "[march]") {
  const auto box = scene_of(R"("objects": [{"type": "box", "half_size": [1, 1, 1]}])");
  const auto ball = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field box_field = make_field(box), ball_field = make_field(ball);
  RealScratch scratch;
  // The ray passes an edge of the box.
  const glm::dvec3 along = glm::normalize(glm::dvec3(1, -1, 0.5));
  const auto past_edge = [&](double gap) {
    return certify(box_field, glm::dvec3(1 + gap, 1 + gap, 0) - 5.0 * along, along, 1, {0, 10, 0}, scratch).status;
  };
  CHECK(past_edge(1e-13) == Status::NearMiss);
  CHECK(past_edge(1e-10) == Status::Miss);
  // A ball's field is nearly level along a tangent ray, but bounds of the derivative exclude a hit without resolving
  // the gap.
  const glm::dvec3 aside = glm::normalize(glm::dvec3(2, -1, 0)), by = glm::normalize(glm::dvec3(1, 2, 3));
  const auto past_ball = [&](double gap) {
    return certify(ball_field, (1 + gap) * aside - 5.0 * by, by, 1, {0, 10, 0}, scratch);
  };
  CHECK(past_ball(1e-13).status == Status::Miss);
  CHECK(past_ball(1e-13).evaluations < 100);
  CHECK(past_ball(-1e-13).status == Status::Hit);
}

TEST_CASE("certify: intervals settle a long ray along a plane in a few evaluations", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "plane", "normal": [0, 1, 0]}])");
  const Field field = make_field(scene);
  RealScratch scratch;
  const CertifiedResult along = certify(field, {0, 1e-6, 0}, {1, 0, 0}, 1, {0, 1e4, 0}, scratch);
  CHECK(along.status == Status::Miss);
  CHECK(along.evaluations < 10);
  const double slope = 1e-6;
  const CertifiedResult down = certify(field, {0, 1e-3, 0}, {1, -slope, 0}, 1, {0, 1e4, 0}, scratch);
  REQUIRE(down.status == Status::Hit);
  CHECK(down.t == Approx(1000).epsilon(1e-6));
  CHECK(down.evaluations < 200);
}

// A scene with grazing rays along a fractal, and with a blend.
compiler::CompiledScene difficult_scene() {
  return scene_of(R"("objects": [
      {"type": "mandelbulb", "power": 8, "iterations": 8, "bailout": 16, "detail": 0.0005},
      {"type": "smooth_union", "k": 0.2, "translate": [1.5, 0, 0], "of": [
        {"type": "sphere", "radius": 0.5}, {"type": "box", "half_size": [0.4, 0.1, 0.4], "translate": [0, 0.5, 0]}]}])");
}

bool same(const RayHit& a, const RayHit& b) {
  return a.status == b.status && a.side == b.side && a.t == b.t && a.width == b.width &&
         a.evaluations == b.evaluations && a.certified == b.certified && a.instructions == b.instructions;
}

TEST_CASE("certify: rays that are searched side by side end as each does alone", "[march][isa]") {
  const test::IsaGuard guard;
  const auto scene = difficult_scene();
  const Field field = make_field(scene);
  // Short enough to end inside the bounding box, so that no ray is clipped.
  Random random(8);
  std::vector<Ray> rays;
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 from(random.uniform(-1, 1), random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9));
    rays.push_back({from, random.direction(), 0.1});
  }
  std::vector<CertifiedResult> alone;
  RealScratch scratch;
  int hits = 0;
  for (const Ray& ray : rays) {
    alone.push_back(certify(field, ray.origin, ray.direction, 0, {0, 0.1, 0}, scratch));
    hits += alone.back().status == Status::Hit;
  }
  REQUIRE(hits > 40);
  for (const std::string_view isa : vm::available_isas()) {
    REQUIRE(vm::force_isa(isa));
    const MarchResult together = march(field, rays, {.method = Method::Certified});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const RayHit& ray_hit = together.ray_hits[i];
      INFO(isa << ", ray " << i);
      CHECK(ray_hit.status == alone[i].status);
      CHECK(ray_hit.t == alone[i].t);
      CHECK(ray_hit.width == static_cast<float>(alone[i].width));
      CHECK(ray_hit.certified == alone[i].evaluations);
      CHECK(ray_hit.instructions == alone[i].instructions);
    }
  }
}

TEST_CASE("certify: in a stream, too, what becomes of a ray depends on that ray alone", "[march]") {
  const auto scene = difficult_scene();
  const Field field = make_field(scene);
  const std::vector<Ray> rays = rays_at_sphere(3000, 3);
  const MarchResult together = march(field, rays);
  REQUIRE(together.counters.certified > 5);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (together.ray_hits[i].certified == 0 && i % 50 != 0) continue;
    INFO("ray " << i);
    RayHit alone = march(field, std::span(rays).subspan(i, 1)).ray_hits[0];
    CHECK(same(alone, together.ray_hits[i]));
  }
}

}  // namespace
}  // namespace fathom::runtime::certify_test
