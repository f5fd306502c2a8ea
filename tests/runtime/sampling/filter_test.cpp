#include "runtime/sampling/filter.h"

#include <array>
#include <cmath>
#include <vector>

#include "runtime/sampling/sampler.h"
#include "tests/support/catch.h"

namespace fathom::runtime::filter_test {
namespace {

constexpr FilterKind kFilters[] = {FilterKind::Box, FilterKind::Tent, FilterKind::Gaussian,
                                   FilterKind::BlackmanHarris, FilterKind::Mitchell};

// Integrates g over f(|x| / radius) from x = a to b, by Simpson's rule.
template <typename Function>
double integral(FilterKind kind, double a, double b, double radius, const Function& g) {
  const int steps = 4000;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double x = a + (b - a) * i / steps;
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * g(filter_value(kind, std::min(std::abs(x) / radius, 1.0)), x);
  }
  return sum * (b - a) / steps / 3;
}

TEST_CASE("filter: the shapes are those of the books", "[sampling]") {
  CHECK(filter_value(FilterKind::Gaussian, 1) == Approx(0).margin(1e-6));
  // The standard deviation is a third of the radius.
  CHECK(filter_value(FilterKind::Gaussian, 1.0 / 3) == Approx(std::exp(-0.5) - std::exp(-4.5)).epsilon(1e-5));
  CHECK(filter_value(FilterKind::BlackmanHarris, 0) == Approx(1));
  CHECK(filter_value(FilterKind::BlackmanHarris, 1) == Approx(6e-5).epsilon(1e-3));
  CHECK(filter_value(FilterKind::Mitchell, 0) == Approx(8.0 / 9));
  CHECK(filter_value(FilterKind::Mitchell, 0.5) == Approx(1.0 / 18));
  CHECK(filter_value(FilterKind::Mitchell, 1) == Approx(0).margin(1e-15));
  CHECK(filter_value(FilterKind::Mitchell, 0.7) < 0);
  // The Mitchell filter's values at points one pixel apart add up to 1 everywhere.
  for (const double x : {0.0, 0.2, 0.5, 0.9}) {
    double sum = 0;
    for (int i = -3; i <= 3; ++i) {
      const double t = std::abs(x + i) / 2;
      if (t <= 1) sum += filter_value(FilterKind::Mitchell, t);
    }
    CHECK(sum == Approx(1));
  }
}

TEST_CASE("filter: the box of one pixel takes the numbers as they are, bit for bit", "[sampling]") {
  const Filter box;
  Sampler sampler(1, 2, 3, 4);
  for (int i = 0; i < 100000; ++i) {
    const glm::vec2 u = sampler.next2();
    const FilterSample sample = box.sample(u);
    if (sample.offset != u - 0.5f || sample.weight != 1) FAIL("at " << u.x << " " << u.y);
  }
}

TEST_CASE("filter: offsets are as dense as the filter's magnitude says", "[sampling]") {
  for (const FilterKind kind : kFilters) {
    for (const double width : {0.0, 1.7}) {
      const Filter filter = width > 0 ? Filter(kind, width) : Filter(kind);
      const double radius = filter.radius();
      constexpr int kBins = 48;
      std::vector<int> along_x(kBins), along_y(kBins);
      const int n = 1 << 17;
      Sampler sampler(5, 0, 0, 0);
      for (int i = 0; i < n; ++i) {
        const FilterSample sample = filter.sample(sampler.next2());
        const auto bin = [&](float offset) {
          const double place = (static_cast<double>(offset) / radius + 1) / 2 * kBins;
          return std::min<std::size_t>(static_cast<std::size_t>(std::max(place, 0.0)), kBins - 1);
        };
        REQUIRE(std::abs(sample.offset.x) <= static_cast<float>(radius));
        ++along_x[bin(sample.offset.x)];
        ++along_y[bin(sample.offset.y)];
      }
      const auto magnitude = [](double f, double) { return std::abs(f); };
      const double all = integral(kind, -radius, radius, radius, magnitude);
      double chi_x = 0, chi_y = 0;
      int cells = 0;
      for (int b = 0; b < kBins; ++b) {
        const double lo = radius * (2.0 * b / kBins - 1), hi = radius * (2.0 * (b + 1) / kBins - 1);
        const double expected = n * integral(kind, lo, hi, radius, magnitude) / all;
        if (expected < 5) continue;
        const auto at = static_cast<std::size_t>(b);
        chi_x += (along_x[at] - expected) * (along_x[at] - expected) / expected;
        chi_y += (along_y[at] - expected) * (along_y[at] - expected) / expected;
        ++cells;
      }
      CAPTURE(static_cast<int>(kind), width, cells);
      REQUIRE(cells > 30);
      CHECK(chi_x < cells + 4 * std::sqrt(2.0 * cells));
      CHECK(chi_y < cells + 4 * std::sqrt(2.0 * cells));
    }
  }
}

// Means of weight, weight * offset and weight * offset^2 along an axis. The grid of u is so fine that its error, from
// the step where the sign changes, is below 2e-5.
std::array<double, 3> moments(const Filter& filter, int axis) {
  const int n = 1 << 18;
  // A sample's weight is a product. This is the factor of the other axis.
  const double other = std::sqrt(static_cast<double>(filter.sample({0.5f, 0.5f}).weight));
  std::array<double, 3> sums{};
  for (int i = 0; i < n; ++i) {
    glm::vec2 u(0.5f);
    u[axis] = (static_cast<float>(i) + 0.5f) / n;
    const FilterSample sample = filter.sample(u);
    const double w = static_cast<double>(sample.weight) / other / n, x = static_cast<double>(sample.offset[axis]);
    sums[0] += w;
    sums[1] += w * x;
    sums[2] += w * x * x;
  }
  return sums;
}

TEST_CASE("filter: a constant stays, a ramp stays, a parabola gains the filter's second moment", "[sampling]") {
  for (const FilterKind kind : kFilters) {
    const Filter filter(kind);
    const double radius = filter.radius();
    const double whole = integral(kind, -radius, radius, radius, [](double f, double) { return f; });
    const double second = integral(kind, -radius, radius, radius, [](double f, double x) { return f * x * x; });
    for (int axis = 0; axis < 2; ++axis) {
      const auto [weight, first, square] = moments(filter, axis);
      CAPTURE(static_cast<int>(kind), axis);
      CHECK(weight == Approx(1).margin(2e-5));
      CHECK(first == Approx(0).margin(2e-5));
      CHECK(square == Approx(second / whole).margin(5e-5));
    }
  }
}

TEST_CASE("filter: only the Mitchell filter has negative weights, and all weights of one are of one size",
          "[sampling]") {
  for (const FilterKind kind : kFilters) {
    const Filter filter(kind);
    Sampler sampler(6, 0, 0, 0);
    int negative = 0;
    const float size = std::abs(filter.sample({0.5f, 0.5f}).weight);
    for (int i = 0; i < 20000; ++i) {
      const FilterSample sample = filter.sample(sampler.next2());
      CHECK(std::abs(sample.weight) == size);
      negative += sample.weight < 0;
    }
    CAPTURE(static_cast<int>(kind));
    CHECK((kind == FilterKind::Mitchell ? negative > 1000 : negative == 0 && size == 1));
  }
}

TEST_CASE("filter: samples in order of u are in order in the picture", "[sampling]") {
  for (const FilterKind kind : kFilters) {
    const Filter filter(kind);
    float before = -100;
    for (int i = 0; i < 5000; ++i) {
      const float x = filter.sample({static_cast<float>(i) / 5000, 0.3f}).offset.x;
      if (!(x > before)) FAIL("at " << i);
      before = x;
    }
  }
}

}  // namespace
}  // namespace fathom::runtime::filter_test
