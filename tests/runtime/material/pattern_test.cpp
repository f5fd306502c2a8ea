#include "runtime/material/pattern.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::pattern_test {
namespace {

using compiler::Pattern;
using glm::dvec3;

dvec3 random_point(Sampler& sampler, double size) {
  const auto next = [&] { return size * (2 * static_cast<double>(sampler.next()) - 1); };
  const double x = next(), y = next();
  return {x, y, next()};
}

TEST_CASE("pattern: a checker changes from cube to cube", "[material][pattern]") {
  CHECK(checker({0.5, 0.5, 0.5}) == 0);
  CHECK(checker({1.5, 0.5, 0.5}) == 1);
  CHECK(checker({1.5, 1.5, 0.5}) == 0);
  CHECK(checker({1.5, 1.5, -0.5}) == 1);
  CHECK(checker({-0.5, -0.5, -0.5}) == 1);
  CHECK(checker({-0.5, -1.5, 0.5}) == 1);
  CHECK(checker({1e50, 0, 0}) == 0.5);
  CHECK(checker({0x1p40 - 0.5, 0.5, 0.5}) == 1);
}

TEST_CASE("pattern: a plane where cubes end is of one layer", "[material][pattern]") {
  for (const double height : {0.0, 1.0, -3.0}) {
    for (const double off : {-1e-5, 0.0, 1e-5}) {
      CHECK(checker({0.3, height + off, 0.7}) == static_cast<double>(static_cast<int>(std::abs(height)) % 2));
    }
  }
}

TEST_CASE("pattern: stripes have their width and their softness", "[material][pattern]") {
  const Pattern::Stripes hard{{0, 1, 0}, 0.25, 0}, soft{{0, 1, 0}, 0.25, 1};
  double mean_hard = 0, mean_soft = 0, steepest = 0, last = stripes(soft, {0, -kOffset, 0});
  CHECK(last == Approx(0.5));
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    const double y = -2 + 4.0 * i / kSteps;
    CHECK(stripes(hard, {7, y, -3}) == (y + kOffset - std::floor(y + kOffset) < 0.25 ? 0 : 1));
    mean_hard += stripes(hard, {0, y, 0}) / kSteps;
  }
  for (int i = 1; i <= kSteps; ++i) {
    const double now = stripes(soft, {0, -kOffset + 4.0 * i / kSteps, 0});
    CHECK(now >= 0);
    CHECK(now <= 1);
    steepest = std::max(steepest, std::abs(now - last) * kSteps / 4);
    mean_soft += now / kSteps;
    last = now;
  }
  CHECK(mean_hard == Approx(0.75).margin(2e-3));
  CHECK(mean_soft == Approx(0.75).margin(2e-3));
  CHECK(steepest <= 6.01);  // 1.5 over a transition of 0.25
  CHECK(stripes(soft, {0, 0.125 - kOffset, 0}) == Approx(0).margin(1e-12));
  CHECK(stripes(soft, {0, 0.625 - kOffset, 0}) == Approx(1).margin(1e-12));
}

TEST_CASE("pattern: a gradient is linear between its ends", "[material][pattern]") {
  const Pattern::Gradient g{{1, 0, 0}, {1, 4, 0}};
  CHECK(gradient(g, {9, -1, 3}) == 0);
  CHECK(gradient(g, {9, 1, 3}) == 0.25);
  CHECK(gradient(g, {-9, 3, 0}) == 0.75);
  CHECK(gradient(g, {1, 5, 0}) == 1);
}

TEST_CASE("pattern: bricks are moved row by row", "[material][pattern]") {
  const Pattern::Bricks b{1, 0.5, 0.1, 0.5};
  CHECK(bricks(b, {0.5, 0.25, 0}) == 0);   // the middle of a brick
  CHECK(bricks(b, {0.02, 0.25, 5}) == 1);  // the brick's side
  CHECK(bricks(b, {0.5, 0.02, -5}) == 1);  // the brick's bottom
  CHECK(bricks(b, {0.0, 0.75, 0}) == 0);   // in the next row, a brick is above the joint
  CHECK(bricks(b, {0.5, 0.75, 0}) == 1);
  CHECK(bricks(b, {0.5, -0.25, 0}) == 1);
  Sampler sampler(1, 0, 0, 0);
  const int count = test::scaled_cases(100000);
  double mortar = 0;
  for (int i = 0; i < count; ++i) mortar += bricks(b, random_point(sampler, 100)) / count;
  CHECK(mortar == Approx(1 - 0.9 * 0.8).margin(0.02));
}

TEST_CASE("pattern: noise keeps its range and mean, near zero and far off", "[material][pattern]") {
  for (const double size : {10.0, 1e6, 1e9}) {
    Sampler sampler(2, 0, 0, 0);
    const int count = test::scaled_cases(40000);
    double mean = 0, square = 0, least = 2, most = -2;
    for (int i = 0; i < count; ++i) {
      const double v = gradient_noise(random_point(sampler, size), 5);
      least = std::min(least, v);
      most = std::max(most, v);
      mean += v / count;
      square += v * v / count;
    }
    CAPTURE(size, least, most, mean, square);
    CHECK(least >= -1.04);
    CHECK(most <= 1.04);
    CHECK(least < -0.7);
    CHECK(most > 0.7);
    CHECK(std::abs(mean) < 4 * std::sqrt(square / count) + 2e-3);
    CHECK(square == Approx(0.0702).margin(0.008));  // the same variance everywhere
  }
  CHECK(gradient_noise({3, -2, 7}, 5) == 0);
  CHECK(gradient_noise({1e30, 0, 0}, 5) == 0);
}

TEST_CASE("pattern: noise is continuous with its slope, across cells too", "[material][pattern]") {
  Sampler sampler(3, 0, 0, 0);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < test::scaled_cases(20000); ++i) {
    dvec3 p = random_point(sampler, 1000);
    if (i % 2 == 0) p[i / 2 % 3] = std::round(p[i / 2 % 3]);  // on a face of a cell
    dvec3 step(0);
    step[i % 3] = kStep;
    const double before = gradient_noise(p - step, 9), here = gradient_noise(p, 9),
                 after = gradient_noise(p + step, 9);
    CHECK(std::abs(after - here) < 8 * kStep);
    CHECK(std::abs(after - 2 * here + before) < 60 * kStep * kStep + 1e-14);
  }
}

TEST_CASE("pattern: octaves add up within [0,1], seeds differ, and no plane is flat", "[material][pattern]") {
  const Pattern::Noise n{4, 0.5, 2, 1, 0}, other{4, 0.5, 2, 1, 1}, strong{4, 0.5, 2, 50, 0};
  Sampler sampler(4, 0, 0, 0);
  double mean = 0, plane = 0, difference = 0;
  int ends = 0;
  const int count = test::scaled_cases(10000);
  for (int i = 0; i < count; ++i) {
    dvec3 p = random_point(sampler, 50);
    const double v = noise(n, p), w = noise(strong, p);
    CHECK(v >= 0);
    CHECK(v <= 1);
    ends += w == 0 || w == 1;
    mean += v / count;
    difference += std::abs(v - noise(other, p)) / count;
    p = {std::round(p.x), 0, std::round(p.z)};
    plane += std::abs(noise(n, p) - 0.5) / count;
  }
  CHECK(mean == Approx(0.5).margin(0.01));
  CHECK(difference > 0.05);
  CHECK(plane > 0.03);
  CHECK(ends > count / 2);
}

TEST_CASE("pattern: noise does not repeat along the axes", "[material][pattern]") {
  for (const int period : {1, 16, 256, 65536}) {
    double difference = 0;
    for (int i = 0; i < 1000; ++i) {
      const dvec3 p(0.37 + i, 0.51 - 3 * i, 0.83 + 7 * i);
      for (int axis = 0; axis < 3; ++axis) {
        dvec3 q = p;
        q[axis] += period;
        difference += std::abs(gradient_noise(p, 0) - gradient_noise(q, 0)) / 3000;
      }
    }
    CAPTURE(period);
    CHECK(difference > 0.15);
  }
}

TEST_CASE("pattern: what is no place has no value", "[material][pattern]") {
  const compiler::Affine still{{dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)}, dvec3(0)};
  CHECK(std::isnan(pattern_value({Pattern::Checker{}, still, 0, 0}, dvec3(NAN, 0, 0))));
  CHECK(pattern_value({Pattern::Checker{}, still, 0, 0}, dvec3(1.5, 0.5, 0.5)) == 1);
}

}  // namespace
}  // namespace fathom::runtime::pattern_test
