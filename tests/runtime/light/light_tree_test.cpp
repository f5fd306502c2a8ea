// The choice of a light: probabilities sum to 1, choices follow the probabilities, and every light that matters can
// be chosen.
#include "runtime/light/light_tree.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"
#include "tests/support/sample_bins.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::light_tree_test {
namespace {

std::vector<LightBounds> random_lights(std::uint32_t count) {
  std::vector<LightBounds> lights;
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler s(7, i, 0, 0);
    const auto spread = [&](float size) { return static_cast<double>((s.next() - 0.5f) * size); };
    LightBounds light;
    light.centre = {spread(20), spread(4), spread(20)};
    light.radius = 0.3 * static_cast<double>(s.next());
    light.intensity = 0.1f + s.next();
    if (i % 3 != 0) {
      light.axis = glm::normalize(glm::vec3(spread(1), -0.5, spread(1)));
      light.cos_spread = 1;
      light.two_sided = i % 3 == 1;
      light.cos_emission = light.two_sided ? 0 : 0.7f;
    }
    lights.push_back(light);
  }
  return lights;
}

const LightSampleContext kQueries[] = {
    {{0, -3, 0}, {0, 1, 0}}, {{3, 0, -2}, {0.6f, 0, 0.8f}}, {{40, 9, 0}, {-1, 0, 0}}, {{1, 1, 1}, {0, -1, 0}, true}};

TEST_CASE("light tree: probabilities sum to 1, and choices follow them", "[light]") {
  for (const std::uint32_t count : {1u, 5u, 32u, 33u, 500u}) {
    const LightTree tree(random_lights(count));
    for (const LightSampleContext& query : kQueries) {
      std::vector<double> expected;
      double sum = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        expected.push_back(static_cast<double>(tree.pmf(query, i)));
        sum += expected.back();
      }
      std::vector<double> counts(count + 1);
      const int n = test::scaled_cases(20000);
      double worst = 0;
      for (int i = 0; i < n; ++i) {
        const auto choice = tree.sample(query, Sampler(3, static_cast<std::uint32_t>(i), 0, 0).next());
        ++counts[choice ? choice->light : count];
        if (choice) worst = std::max(worst, std::abs(static_cast<double>(choice->pmf) / expected[choice->light] - 1));
      }
      expected.push_back(std::max(0.0, 1 - sum));
      CAPTURE(count, query.position.x, sum);
      CHECK(sum < 1 + 1e-5);
      // A node's estimate can be above 0 when those of its leaves are all 0. Choosing this node gives no sample.
      CHECK((count > LightTree::kFewLights ? sum > 0.9
                                           : std::abs(sum - 1) < 1e-5 || tree.total_importance(query) == 0));
      CHECK(worst < 1e-4);
      CHECK(test::chi_square_deviation(counts, expected, n) < 5);
    }
  }
}

TEST_CASE("light tree: what light can reach has a probability", "[light]") {
  const std::vector<LightBounds> lights = random_lights(300);
  const LightTree tree(lights);
  int checked = 0;
  for (std::uint32_t k = 0; k < 200; ++k) {
    Sampler s(11, k, 0, 0);
    const auto spread = [&](float size) { return static_cast<double>((s.next() - 0.5f) * size); };
    const LightSampleContext query{{spread(30), spread(8), spread(30)},
                                   glm::normalize(glm::vec3(spread(1), spread(1), spread(1)))};
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      const LightBounds& light = lights[i];
      const glm::dvec3 way = light.centre - query.position;
      const glm::vec3 wi(glm::normalize(way));
      const float leaving = -glm::dot(wi, light.axis);
      const bool shines =
          light.cos_spread < 0 || (light.two_sided ? std::abs(leaving) : leaving) > light.cos_emission;
      if (!shines || glm::dot(query.normal, wi) <= 0.01f) continue;
      ++checked;
      if (tree.pmf(query, i) <= 0) FAIL("light " << i << " of query " << k);
    }
  }
  CHECK(checked > 5000);
}

TEST_CASE("light tree: an estimate is the irradiance of what is far and faces the place", "[light]") {
  LightBounds light;
  light.centre = {0, 10, 0};
  light.intensity = 4;
  CHECK(importance(light, {{0, 0, 0}, {0, 1, 0}}) == Approx(0.04));
  CHECK(importance(light, {{0, 0, 0}, {0.6f, 0.8f, 0}}) == Approx(0.032));
  CHECK(importance(light, {{0, 0, 0}, {0, -1, 0}}) == 0);
  CHECK(importance(light, {{0, 0, 0}, {0, -1, 0}, true}) == Approx(0.04));
  light.cos_spread = 1;
  light.axis = {0, 1, 0};
  CHECK(importance(light, {{0, 0, 0}, {0, 1, 0}}) == 0);
  light.two_sided = true;
  CHECK(importance(light, {{0, 0, 0}, {0, 1, 0}}) == Approx(0.04));
}

TEST_CASE("light tree: near() finds every ball in reach", "[light]") {
  const std::vector<LightBounds> lights = random_lights(400);
  const LightTree tree(lights);
  for (std::uint32_t k = 0; k < 50; ++k) {
    Sampler s(13, k, 0, 0);
    const auto spread = [&](float size) { return static_cast<double>((s.next() - 0.5f) * size); };
    const glm::dvec3 place(spread(20), spread(4), spread(20));
    std::vector<std::uint32_t> found, truth;
    tree.for_each_near(place, 0.5, [&](std::uint32_t i) { found.push_back(i); });
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      if (glm::length(lights[i].centre - place) <= lights[i].radius + 0.5) truth.push_back(i);
    }
    std::sort(found.begin(), found.end());
    CHECK(found == truth);
  }
}

}  // namespace
}  // namespace fathom::runtime::light_tree_test
