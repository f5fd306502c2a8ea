#include "tests/support/chi_square.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "runtime/sampling/warp.h"

namespace fathom::test {
namespace {

// Gauss-Legendre quadrature rule of 3 points on [-1,1].
constexpr std::array<double, 3> kPlaces{-0.7745966692414834, 0, 0.7745966692414834};
constexpr std::array<double, 3> kWeights{5.0 / 9, 8.0 / 9, 5.0 / 9};
constexpr int kMaxDepth = 7, kMaxGuidedDepth = 12;
constexpr std::size_t kGuides = 8;  // max per cell

// Polar angle and azimuth, the azimuth in [-pi,pi].
struct Place {
  double theta, phi;
};
Place place_of(glm::vec3 local) {
  const glm::dvec3 w(local);
  return {std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z), std::atan2(w.y, w.x)};
}

struct Cell {
  double theta0, theta1, phi0, phi1;
  bool holds(Place p) const { return p.theta >= theta0 && p.theta < theta1 && p.phi >= phi0 && p.phi < phi1; }
};

// Cells of the sphere: [row * columns + column].
std::vector<Cell> cells(int rows, int columns) {
  std::vector<Cell> all;
  const double dt = M_PI / rows, dp = 2 * M_PI / columns;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      all.push_back({row * dt, (row + 1) * dt, column * dp - M_PI, (column + 1) * dp - M_PI});
    }
  }
  return all;
}

class Integral {
 public:
  Integral(const DirectionPdf& pdf, const runtime::Frame& frame, double tolerance)
      : pdf_(pdf), frame_(frame), tolerance_(tolerance) {}

  // Integrates over at least four parts of the cell, so that no peak hides between the rule's points.
  double over(const Cell& c) const {
    double sum = 0;
    for (const Cell& part : quarters(c)) sum += refine(part, rule(part), kMaxDepth);
    return sum;
  }

  double guided(const Cell& c, std::span<const Place> guides, int depth) const {
    std::vector<Place> within;
    std::copy_if(guides.begin(), guides.end(), std::back_inserter(within), [&](Place p) { return c.holds(p); });
    if (within.size() <= kGuides || depth == 0) return over(c);
    double sum = 0;
    for (const Cell& part : quarters(c)) sum += guided(part, within, depth - 1);
    return sum;
  }

 private:
  static std::array<Cell, 4> quarters(const Cell& c) {
    const double theta = (c.theta0 + c.theta1) / 2, phi = (c.phi0 + c.phi1) / 2;
    return {{{c.theta0, theta, c.phi0, phi},
             {theta, c.theta1, c.phi0, phi},
             {c.theta0, theta, phi, c.phi1},
             {theta, c.theta1, phi, c.phi1}}};
  }
  double rule(const Cell& c) const {
    double sum = 0;
    const double dt = (c.theta1 - c.theta0) / 2, dp = (c.phi1 - c.phi0) / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      const double theta = c.theta0 + dt * (1 + kPlaces[i]), sine = std::sin(theta), cosine = std::cos(theta);
      for (std::size_t j = 0; j < 3; ++j) {
        const double phi = c.phi0 + dp * (1 + kPlaces[j]);
        const glm::vec3 local(sine * std::cos(phi), sine * std::sin(phi), cosine);
        sum += kWeights[i] * kWeights[j] * sine * pdf_(frame_.to_world(local));
      }
    }
    return sum * dt * dp;
  }
  double refine(const Cell& c, double coarse, int depth) const {
    const std::array<Cell, 4> parts = quarters(c);
    std::array<double, 4> fine;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += fine[i] = rule(parts[i]);
    if (depth == 0 || std::abs(sum - coarse) <= tolerance_) return sum;
    sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += refine(parts[i], fine[i], depth - 1);
    return sum;
  }

  const DirectionPdf& pdf_;
  runtime::Frame frame_;
  double tolerance_;
};

// The regularised incomplete gamma functions: P by its series, Q by its continued fraction. Source: Press et al.,
// "Numerical Recipes", 3rd ed. 2007, section 6.2.
double gamma_series(double a, double x) {
  double term = 1 / a, sum = term;
  for (double n = a + 1; std::abs(term) > 1e-16 * sum; ++n) sum += term *= x / n;
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

double gamma_fraction(double a, double x) {
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 100000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return h * std::exp(a * std::log(x) - x - std::lgamma(a));
}

std::vector<double> count(const DirectionSampler& sample, const runtime::Frame& frame, const ChiSquareSetup& setup) {
  std::vector<double> counts(static_cast<std::size_t>(setup.rows * setup.columns) + 1);
  for (int i = 0; i < setup.samples; ++i) {
    runtime::Sampler sampler(setup.seed, static_cast<std::uint32_t>(i), 0, 0);
    const std::optional<glm::vec3> drawn = sample(sampler);
    if (!drawn) {
      ++counts.back();
      continue;
    }
    const Place place = place_of(frame.to_local(*drawn));
    const int row = std::clamp(static_cast<int>(place.theta / M_PI * setup.rows), 0, setup.rows - 1);
    const double turn = (place.phi + M_PI) / (2 * M_PI);
    const int column = std::clamp(static_cast<int>(turn * setup.columns), 0, setup.columns - 1);
    ++counts[static_cast<std::size_t>(row * setup.columns + column)];
  }
  return counts;
}

std::vector<double> expect(const DirectionPdf& pdf, const runtime::Frame& frame, const ChiSquareSetup& setup) {
  const Integral integral(pdf, frame, 0.1 / setup.samples);
  std::vector<double> expected;
  double sum = 0;
  for (const Cell& cell : cells(setup.rows, setup.columns)) {
    expected.push_back(integral.over(cell) * setup.samples);
    sum += expected.back();
  }
  expected.push_back(std::max(setup.samples - sum, 0.0));
  return expected;
}

}  // namespace

std::string ChiSquare::describe() const {
  return "p " + std::to_string(p) + ", chi^2 " + std::to_string(statistic) + " of " + std::to_string(freedom) +
         " degrees of freedom, the density integrates to " + std::to_string(integral);
}

double chi_square_tail(double statistic, double freedom) {
  const double a = freedom / 2, x = statistic / 2;
  if (!(x > 0)) return 1;
  return x < a + 1 ? 1 - gamma_series(a, x) : gamma_fraction(a, x);
}

double sidak(double alpha, int tests) { return 1 - std::pow(1 - alpha, 1.0 / tests); }

ChiSquare pearson(std::span<const double> counts, std::span<const double> expected) {
  ChiSquare result;
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  // Pools cells in ascending order of their expected count until each pool expects 5. Cells in which nothing may ever
  // fall end up in the first pool.
  double counted = 0, awaited = 0;
  int cells = 0;
  for (const std::size_t i : order) {
    counted += counts[i];
    awaited += expected[i];
    if (awaited < 5) continue;
    result.statistic += (counted - awaited) * (counted - awaited) / awaited;
    counted = awaited = 0;
    ++cells;
  }
  result.freedom = std::max(cells - 1, 1);
  result.p = chi_square_tail(result.statistic, result.freedom);
  return result;
}

ChiSquare chi_square(const DirectionSampler& sample, const DirectionPdf& pdf, const ChiSquareSetup& setup) {
  const runtime::Frame frame(setup.pole);
  const std::vector<double> counts = count(sample, frame, setup), expected = expect(pdf, frame, setup);
  ChiSquare result = pearson(counts, expected);
  for (std::size_t i = 0; i + 1 < expected.size(); ++i) result.integral += expected[i] / setup.samples;
  return result;
}

double sphere_integral(const DirectionPdf& f, const SphereRule& rule) {
  const runtime::Frame frame(rule.pole);
  const Integral integral(f, frame, rule.tolerance);
  std::vector<Place> places;
  for (const glm::vec3 guide : rule.guides) places.push_back(place_of(frame.to_local(guide)));
  double sum = 0;
  for (const Cell& cell : cells(rule.rows, 2 * rule.rows)) {
    Cell above = cell, below = cell;
    above.theta1 = below.theta0 = std::clamp(rule.step.value_or(0), cell.theta0, cell.theta1);
    for (const Cell& part : {above, below}) {
      if (part.theta0 < part.theta1) sum += integral.guided(part, places, kMaxGuidedDepth);
    }
  }
  return sum;
}

}  // namespace fathom::test
