// Diffuse samples in lanes against Bsdf, bit for bit.
#include "runtime/path/scatter_lanes.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>

#include "runtime/path/scatter.h"
#include "tests/support/catch.h"

namespace fathom::runtime::scatter_lanes_test {
namespace {

// Returns a unit vector: at random, or one for which the frame has a case of its own.
glm::vec3 random_normal(std::mt19937& random) {
  constexpr glm::vec3 kCases[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0.0f}, {0, 1, -0.0f}};
  std::uniform_real_distribution<float> number(-1, 1);
  if (random() % 4 == 0) return kCases[random() % 4];
  return glm::normalize(glm::vec3(number(random), number(random), number(random) + 1e-3f));
}

// Returns a number in [0,1), often one at which a quadrant or a square root has a case of its own.
float random_unit(std::mt19937& random) {
  constexpr float kCases[] = {0, 0x1p-24f, 0.125f, 0.25f, 0.375f, 0.5f, 0.625f, 0.875f, 0x1.fffffep-1f};
  return random() % 4 == 0 ? kCases[random() % 9] : static_cast<float>(random() >> 8) * 0x1p-24f;
}

TEST_CASE("scatter lanes: diffuse samples are those of the BSDF", "[path][render]") {
  std::mt19937 random(1);
  const auto batch = std::make_unique<VertexBatch>();
  MaterialPoint material;
  material.base_color = {0.25f, 0.5f, 1};
  int differences = 0;
  for (int round = 0; round < 400; ++round) {
    batch->count = 1 + random() % kVertexBatch;
    for (std::size_t i = 0; i < batch->count; ++i) {
      batch->normal.set(i, random_normal(random));
      batch->albedo.set(i, material.base_color);
      batch->has_bsdf[i] = false;
      batch->u[i] = random_unit(random);
      batch->v[i] = random_unit(random);
    }
    sample_diffuse(*batch);
    for (std::size_t i = 0; i < batch->count; ++i) {
      const glm::vec3 normal = batch->normal[i];
      const Bsdf bsdf(material, normal, normal, 1, false);
      const BsdfSample expected = bsdf.sample(0, {batch->u[i], batch->v[i]});
      const BsdfValue value = evaluate_bsdf(*batch, i, expected.wi);
      differences += batch->wi[i] != expected.wi || batch->weight[i] != expected.weight ||
                     batch->pdf[i] != expected.pdf || value.pdf != expected.pdf ||
                     value.f != bsdf.evaluate(expected.wi).f;
    }
  }
  CHECK(differences == 0);
}

}  // namespace
}  // namespace fathom::runtime::scatter_lanes_test
