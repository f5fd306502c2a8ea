#include "runtime/sampling/warp.h"

#include <cmath>
#include <vector>

#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"

namespace fathom::runtime::warp_test {
namespace {

TEST_CASE("warp: cosine hemisphere passes a chi-square test against its density", "[sampling]") {
  // Cells of equal cos^2 and equal angle are equally likely: cos^2 theta is uniform for the density cos/pi.
  const int n = 1000000, rows = 20, columns = 40;
  std::vector<int> counts(rows * columns);
  Sampler sampler(1, 0, 0, 0);
  for (int i = 0; i < n; ++i) {
    const glm::vec3 w = square_to_cosine_hemisphere(sampler.next2());
    const double turn = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x)) / (2 * M_PI) + 0.5;
    const int row = std::min(rows - 1, static_cast<int>(static_cast<double>(w.z * w.z) * rows));
    const int column = std::min(columns - 1, static_cast<int>(turn * columns));
    ++counts[static_cast<std::size_t>(row * columns + column)];
  }
  const double expected = static_cast<double>(n) / (rows * columns), freedom = rows * columns - 1;
  double sum = 0;
  for (int count : counts) sum += (count - expected) * (count - expected) / expected;
  CHECK(sum < freedom + 4 * std::sqrt(2 * freedom));
}

TEST_CASE("warp: the cosine density integrates to one", "[sampling]") {
  double sum = 0;
  const int n = 1000;
  for (int i = 0; i < n; ++i) {
    const double z = (i + 0.5) / n;
    sum += static_cast<double>(square_to_cosine_hemisphere_pdf({0, 0, static_cast<float>(z)})) * 2 * M_PI / n;
  }
  CHECK(sum == Approx(1).epsilon(1e-5));
  CHECK(square_to_cosine_hemisphere_pdf({0, 0, -1}) == 0);
}

TEST_CASE("warp: frames are orthonormal for every direction", "[sampling]") {
  Sampler sampler(2, 0, 0, 0);
  std::vector<glm::vec3> normals = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -0.0f}, {-1, 0, 0}};
  normals[4] = {0, -1, -0.0f};
  for (int i = 0; i < 1000; ++i) {
    normals.push_back(
        to_frame(normals[static_cast<std::size_t>(i) % 6], square_to_cosine_hemisphere(sampler.next2())));
  }
  for (glm::vec3 n : normals) {
    n = glm::normalize(n);
    const glm::vec3 x = to_frame(n, {1, 0, 0}), y = to_frame(n, {0, 1, 0}), z = to_frame(n, {0, 0, 1});
    CHECK(glm::length(x) == Approx(1).epsilon(1e-6));
    CHECK(glm::length(y) == Approx(1).epsilon(1e-6));
    CHECK(std::abs(glm::dot(x, y)) < 1e-6f);
    CHECK(std::abs(glm::dot(x, n)) < 1e-6f);
    CHECK(glm::length(glm::cross(x, y) - n) < 2e-6f);
    CHECK(glm::length(z - n) == 0);
  }
}

}  // namespace
}  // namespace fathom::runtime::warp_test
