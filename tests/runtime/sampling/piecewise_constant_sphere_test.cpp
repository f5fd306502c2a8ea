// A table of directions: conversion to longitude and latitude and back, cells sampled by probability. Chi-square
// test: environment_test.cpp.
#include "runtime/sampling/piecewise_constant_sphere.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"

namespace fathom::runtime::sphere_table_test {
namespace {

TEST_CASE("sphere table: longitude and latitude there and back", "[sampling][light]") {
  CHECK(glm::length(from_latlong({0.5, 0.5}) - glm::dvec3(0, 0, -1)) < 1e-15);
  CHECK(glm::length(from_latlong({0.75, 0.5}) - glm::dvec3(1, 0, 0)) < 1e-15);
  CHECK(glm::length(from_latlong({0.2, 0}) - glm::dvec3(0, 1, 0)) < 1e-15);
  for (double u = 0.01; u < 1; u += 0.07) {
    for (double v = 0.01; v < 1; v += 0.07) {
      const glm::dvec2 back = to_latlong(from_latlong({u, v}));
      CHECK(std::abs(back.x - u) < 1e-12);
      CHECK(std::abs(back.y - v) < 1e-12);
    }
  }
}

TEST_CASE("sphere table: a single cell takes every sample", "[sampling][light]") {
  std::vector<float> values(8 * 4, 0.0f);
  values[8 * 1 + 5] = 3;
  const PiecewiseConstantSphere table(8, 4, values);
  const double solid_angle = 2 * M_PI / 8 * (std::cos(M_PI / 4) - std::cos(M_PI / 2));
  CHECK(table.mean() == Approx(3 * solid_angle / (4 * M_PI)));
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const glm::vec3 w = table.sample(Sampler(1, i, 0, 0).next2());
    const glm::dvec2 uv = to_latlong(glm::dvec3(w));
    CHECK((uv.x * 8 > 5 - 1e-5 && uv.x * 8 < 6 + 1e-5 && uv.y * 4 > 1 - 1e-5 && uv.y * 4 < 2 + 1e-5));
    CHECK(glm::length(w) == Approx(1));
  }
  CHECK(table.pdf(glm::vec3(from_latlong({5.5 / 8, 1.5 / 4}))) == Approx(1 / solid_angle));
  CHECK(table.pdf(glm::vec3(from_latlong({4.5 / 8, 1.5 / 4}))) == 0);
  CHECK(PiecewiseConstantSphere(8, 4, std::vector<float>(32, 0.0f)).mean() == 0);
}

TEST_CASE("sphere table: equal values are equal densities", "[sampling][light]") {
  const PiecewiseConstantSphere table(16, 8, std::vector<float>(128, 0.7f));
  CHECK(table.mean() == Approx(0.7));
  for (double v = 0.01; v < 1; v += 0.1)
    CHECK(table.pdf(glm::vec3(from_latlong({0.3, v}))) == Approx(1 / (4 * M_PI)));
}

}  // namespace
}  // namespace fathom::runtime::sphere_table_test
