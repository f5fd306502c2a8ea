#include "runtime/march/clip.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <random>

#include "tests/support/catch.h"
#include "vm/interpret/evaluate.h"

namespace fathom::clip_test {

using namespace fathom;
using namespace fathom::runtime;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Clipped {
  ClipResult result;
  double entry, length;
};

// Clips one ray, slab by slab.
Clipped clip_one(const Ray& ray, const compiler::Box& box, double far) {
  const double squared = glm::dot(ray.direction, ray.direction);
  const bool placed = std::isfinite(ray.origin.x) && std::isfinite(ray.origin.y) && std::isfinite(ray.origin.z);
  if (!(squared > 1e-60 && squared < 1e60) || !placed || std::isnan(ray.t_max)) return {ClipResult::Invalid, 0, 0};
  const glm::dvec3 direction = std::abs(squared - 1) < 1e-6 ? ray.direction : ray.direction / std::sqrt(squared);
  double begin = 0, end = std::min(ray.t_max, far);
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (!(ray.origin[axis] >= box.lo[axis] && ray.origin[axis] <= box.hi[axis])) return {ClipResult::Past, 0, 0};
      continue;
    }
    const double inverse = 1 / direction[axis];
    const double a = (box.lo[axis] - ray.origin[axis]) * inverse, b = (box.hi[axis] - ray.origin[axis]) * inverse;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (box.empty() || !(begin <= end)) return {ClipResult::Past, 0, 0};
  return {ClipResult::Within, begin, end - begin};
}

// Random rays around the origin: towards boxes and away from them, along axes, far too long, and invalid ones.
Ray random_ray(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-4, 4), component(-1, 1);
  std::uniform_int_distribution<int> kind(0, 15);
  Ray ray{{place(random), place(random), place(random)}, {component(random), component(random), component(random)}};
  switch (kind(random)) {
    case 0:
      ray.direction[kind(random) % 3] = 0;
      break;
    case 1:
      ray.direction = {0, 0, 0};
      ray.direction[kind(random) % 3] = component(random) < 0 ? -1 : 1;
      break;
    case 2:
      ray.direction *= kind(random) % 2 ? 1e-35 : 1e35;
      break;
    case 3:
      ray.origin[kind(random) % 3] = kind(random) % 2 ? kNan : kInfinity;
      break;
    case 4:
      ray.t_max = kind(random) % 2 ? kNan : 1.5;
      break;
    default:
      ray.direction = glm::normalize(ray.direction);
  }
  return ray;
}

}  // namespace

TEST_CASE("rays are clipped as one by one, wherever they stand and on every instruction set", "[march]") {
  const compiler::Box boxes[] = {{{-1, -2, -0.5}, {1, 2, 3}},
                                 {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, 0, kInfinity}},
                                 compiler::Box::everything(),
                                 compiler::Box{},
                                 {{1, -1, -1}, {1, 1, 1}}};
  const std::string_view before = vm::isa_name();
  const auto block = std::make_unique<RayBlock>();
  for (const std::string_view isa : vm::available_isas()) {
    REQUIRE(vm::force_isa(isa));
    std::mt19937 random(1);
    std::size_t within = 0, wrong = 0;
    for (int round = 0; round < 400; ++round) {
      const compiler::Box& box = boxes[static_cast<std::size_t>(round) % std::size(boxes)];
      const double far = round % 3 == 0 ? 2.5 : kInfinity;
      const std::size_t count = 1 + random() % RayBlock::kCapacity, first = random() % count;
      std::vector<Ray> rays;
      block->count = 0;
      for (std::size_t i = 0; i < count; ++i) {
        rays.push_back(random_ray(random));
        block->push(static_cast<std::uint32_t>(i), rays.back());
      }
      clip(*block, first, box, far);
      for (std::size_t i = 0; i < count; ++i) {
        if (i < first) {
          // clip() does not change these rays.
          wrong += !(block->length[i] == rays[i].t_max || std::isnan(rays[i].t_max));
          continue;
        }
        const Clipped expected = clip_one(rays[i], box, far);
        bool same = block->clip_result(i) == expected.result && block->id[i] == i;
        if (expected.result == ClipResult::Within) {
          ++within;
          same = same && block->entry[i] == expected.entry && block->length[i] == expected.length &&
                 block->side[i] == (expected.entry > 0 ? 1 : rays[i].side);
        }
        wrong += !same;
      }
    }
    CAPTURE(isa);
    CHECK(wrong == 0);
    CHECK(within > 5000);
  }
  vm::force_isa(before);
}

TEST_CASE("a ray that is clipped begins where it enters the box, in a unit direction", "[march]") {
  const auto block = std::make_unique<RayBlock>();
  block->push(7, {{0, 0, -5}, {0, 0, 2}});
  clip(*block, 0, {{-1, -1, -1}, {1, 1, 1}}, kInfinity);
  REQUIRE(block->clip_result(0) == ClipResult::Within);
  CHECK(block->origin[2][0] == -1);
  CHECK(block->direction[2][0] == 1);
  CHECK(block->entry[0] == 4);
  CHECK(block->length[0] == 2);
  CHECK(block->id[0] == 7);
  CHECK(block->side[0] == 1);
}

}  // namespace fathom::clip_test
