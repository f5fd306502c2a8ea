// A table of directions: conversion to longitude and latitude and back, cells sampled by probability. Chi-square
// test: environment_test.cpp.
#include "runtime/sampling/piecewise_constant_sphere.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"
#include "tests/support/chi_square.h"
#include "tests/support/environments.h"
#include "tests/support/sample_bins.h"
#include "vm/encoding/digest.h"

namespace fathom::runtime::sphere_table_test {
namespace {

// The inverse of from_latlong().
glm::dvec2 to_latlong(glm::dvec3 d) {
  const double u = std::atan2(-d.x, d.z) / (2 * M_PI);
  return {u < 0 ? u + 1 : u, std::acos(glm::clamp(d.y, -1.0, 1.0)) / M_PI};
}

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

using test::look, test::sample_of;

TEST_CASE("sphere table: a single cell takes every sample", "[sampling][light]") {
  std::vector<float> values(8 * 4, 0.0f);
  values[8 * 1 + 5] = 3;
  const PiecewiseConstantSphere table(8, 4, values, {});
  const double solid_angle = 2 * M_PI / 8 * (std::cos(M_PI / 4) - std::cos(M_PI / 2));
  CHECK(table.mean() == Approx(3 * solid_angle / (4 * M_PI)));
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const test::Seen sample = sample_of(table, Sampler(1, i, 0, 0).next2());
    const glm::dvec2 uv = to_latlong(glm::dvec3(sample.direction));
    CHECK((uv.x * 8 > 5 - 1e-5 && uv.x * 8 < 6 + 1e-5 && uv.y * 4 > 1 - 1e-5 && uv.y * 4 < 2 + 1e-5));
    CHECK(glm::length(sample.direction) == Approx(1));
    CHECK(sample.pdf == Approx(1 / solid_angle));
  }
  CHECK(look(table, glm::vec3(from_latlong({5.5 / 8, 1.5 / 4}))).pdf == Approx(1 / solid_angle));
  CHECK(look(table, glm::vec3(from_latlong({4.5 / 8, 1.5 / 4}))).pdf == 0);
  CHECK(PiecewiseConstantSphere(8, 4, std::vector<float>(32, 0.0f), {}).mean() == 0);
}

TEST_CASE("sphere table: equal values are equal densities", "[sampling][light]") {
  for (const glm::ivec2 size : {glm::ivec2(16, 8), glm::ivec2(1, 1), glm::ivec2(3, 5), glm::ivec2(2, 1)}) {
    const PiecewiseConstantSphere table(size.x, size.y,
                                        std::vector<float>(static_cast<std::size_t>(size.x * size.y), 0.7f), {});
    CHECK(table.mean() == Approx(0.7));
    for (double v = 0.01; v < 1; v += 0.1)
      CHECK(look(table, glm::vec3(from_latlong({0.3, v}))).pdf == Approx(1 / (4 * M_PI)));
  }
}

// Values of very different sizes, many of them 0: cells of long bins, and bins of many cells.
std::vector<float> uneven_values(int cells) {
  std::vector<float> values;
  for (int i = 0; i < cells; ++i) {
    const float u = Sampler(3, static_cast<std::uint32_t>(i), 0, 0).next();
    values.push_back(i % 5 == 2 || i / 40 % 7 == 3 ? 0 : u * u * u * u * (i % 97 == 11 ? 1e5f : 1.0f));
  }
  return values;
}

TEST_CASE("sphere table: samples lie in their cells, with the densities of these", "[sampling][light]") {
  for (const glm::ivec2 size : {glm::ivec2(40, 20), glm::ivec2(64, 33), glm::ivec2(7, 300), glm::ivec2(1, 9)}) {
    CAPTURE(size.x, size.y);
    const std::vector<float> values = uneven_values(size.x * size.y);
    const PiecewiseConstantSphere table(size.x, size.y, values, {});
    constexpr float kTurn = 0.7f;
    std::vector<double> counts(values.size()), expected;
    constexpr int kSamples = 20000;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      const test::Seen sample = sample_of(table, Sampler(2, i, 0, 0).next2(), kTurn);
      const glm::dvec2 uv = to_latlong(glm::dvec3(sample.direction));
      const auto cell = [](double place, int cells) { return std::min(static_cast<int>(place * cells), cells - 1); };
      const double turned = uv.x + 0.3 - (uv.x + 0.3 < 1 ? 0 : 1);
      const int column = cell(turned, size.x), row = cell(uv.y, size.y);
      const double middle = std::cos(M_PI * row / size.y) - std::cos(M_PI * (row + 1) / size.y);
      const std::size_t index = static_cast<std::size_t>(row * size.x + column);
      // A direction at a border may be rounded to the next cell.
      const double edge = 1e-4, x = turned * size.x - column, y = uv.y * size.y - row;
      if (x < edge || x > 1 - edge || y < edge || y > 1 - edge) continue;
      const double density = static_cast<double>(values[index]) / (4 * M_PI * table.mean());
      CHECK(static_cast<double>(sample.pdf) == Approx(density).epsilon(2e-3).margin(1e-5 / middle));
      CHECK(look(table, sample.direction, kTurn).pdf == sample.pdf);
      CHECK(values[index] > 0);
      ++counts[index];
    }
    for (int row = 0; row < size.y; ++row) {
      const double height = std::cos(M_PI * row / size.y) - std::cos(M_PI * (row + 1) / size.y);
      for (int column = 0; column < size.x; ++column) {
        expected.push_back(static_cast<double>(values[static_cast<std::size_t>(row * size.x + column)]) * height /
                           (2 * table.mean() * size.x));
      }
    }
    CHECK(std::abs(test::chi_square_deviation(counts, expected, kSamples)) < 5);
  }
}

// Heights have few digits near the poles: of floats there are twenty in the first of 2048 rows.
TEST_CASE("sphere table: samples at a pole are uniform per solid angle", "[sampling][light]") {
  constexpr int kHeight = 2048, kBins = 50, kSamples = 20000;
  for (const int row : {0, kHeight - 1}) {
    std::vector<float> values(kHeight, 0.0f);
    values[static_cast<std::size_t>(row)] = 1;
    const PiecewiseConstantSphere table(1, kHeight, values, {});
    const double rim = std::sin(M_PI / kHeight);
    std::vector<double> counts(kBins), expected(kBins, 1.0 / kBins);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      const glm::dvec3 w(sample_of(table, Sampler(2, i, 0, 0).next2()).direction);
      CHECK(w.y * (row == 0 ? 1 : -1) > 0.99999);
      const double share = (w.x * w.x + w.z * w.z) / (rim * rim);
      ++counts[std::min(static_cast<std::size_t>(share * kBins), std::size_t{kBins - 1})];
    }
    CHECK(std::abs(test::chi_square_deviation(counts, expected, kSamples)) < 5);
  }
}

TEST_CASE("sphere table: an image is interpolated, across the ends of its rows and at the poles",
          "[sampling][light]") {
  const std::vector<glm::vec3> pixels = {{2, 0, 0}, {4, 0, 0}, {8, 0, 2}, {16, 0, 2}, {32, 6, 0}, {64, 6, 0}};
  const PiecewiseConstantSphere table(3, 2, std::vector<float>(6, 1.0f), pixels);
  const auto red = [&](double u, double v) { return look(table, glm::vec3(from_latlong({u, v}))).radiance.x; };
  CHECK(red(1.0 / 6, 0.25) == Approx(2));
  CHECK(red(1.0 / 3, 0.25) == Approx(3));
  CHECK(red(0, 0.25) == Approx(5));  // half of the last pixel, half of the first
  CHECK(red(0.999999, 0.25) == Approx(5).epsilon(1e-4));
  CHECK(red(1.0 / 6, 0.5) == Approx(9));
  CHECK(red(1.0 / 6, 0.01) == Approx(2));  // above the middles of the first row
  CHECK(red(0.5, 0.99) == Approx(32));
  CHECK(look(table, glm::vec3(from_latlong({0.5, 0.75}))).radiance == glm::vec3(32, 6, 0));
}

TEST_CASE("sphere table: every direction has a place", "[sampling][light]") {
  const PiecewiseConstantSphere table(5, 3, std::vector<float>(15, 1.0f), std::vector<glm::vec3>(15, glm::vec3(1)));
  const float inf = INFINITY;
  for (const glm::vec3 w : {glm::vec3(0), glm::vec3(NAN), glm::vec3(inf, -inf, inf), glm::vec3(0, 1, 0),
                            glm::vec3(0, -1, 0), glm::vec3(-0.0f, 0, 1), glm::vec3(1e-30f, 1e30f, -1e30f)}) {
    const test::Seen found = look(table, w, 0.1f);
    CHECK(found.radiance.x == Approx(1));
    CHECK(found.pdf == Approx(1 / (4 * M_PI)));
  }
}

TEST_CASE("sphere table: the same bits on every processor", "[sampling][light][isa]") {
  const std::vector<float> values = uneven_values(40 * 20);
  std::vector<glm::vec3> pixels;
  for (const float value : values) pixels.push_back(3.0f * glm::vec3(value, 1 - value, value * value));
  const PiecewiseConstantSphere table(40, 20, values, pixels);
  std::string bytes;
  const auto add = [&](const DirectionRows& rows, std::size_t count) {
    for (const float* row : {rows.direction[0], rows.direction[1], rows.direction[2], rows.light[0]}) {
      bytes.append(reinterpret_cast<const char*>(row), (row == rows.light[0] ? 4 : 1) * count * sizeof(float));
    }
  };
  for (std::uint32_t round = 0; round < 20; ++round) {
    const std::size_t count = 45 + round;
    DirectionRows rows;
    alignas(64) float u[DirectionRows::kCapacity] = {}, v[DirectionRows::kCapacity] = {};
    for (std::size_t i = 0; i < count; ++i) {
      Sampler sampler(6, static_cast<std::uint32_t>(i), round, 0);
      u[i] = sampler.next();
      v[i] = sampler.next();
    }
    table.sample(count, u, v, 0.3f, rows);
    add(rows, count);
    for (std::size_t i = 0; i < count; ++i) {
      rows.set_direction(i, glm::vec3(u[i] - 0.5f, v[i] - 0.5f, u[count - 1 - i] - 0.5f));
    }
    table.look_up(count, 0.3f, rows);
    add(rows, count);
  }
  CHECK(vm::digest(bytes).text() == "97c8df416e1f0d960067bf26f4058b09");
}

}  // namespace
}  // namespace fathom::runtime::sphere_table_test
