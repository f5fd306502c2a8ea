// Pearson's test of whether directions are drawn with the density that they are said to have.
//
// The sphere is cut into cells of polar angle and azimuth; the density is integrated over each (adaptive Gauss rule,
// in double) and held against what fell into it. Cells that expect fewer than 5 go together, and what was not drawn
// at all is one more cell: a density may integrate to less than 1. A step of the density must run along sides of
// cells: of what it cuts off a corner the rule may see nothing, and stop (a disc's rim across cells of 4.5 degrees
// cost 4e-5 of its integral, which a million samples show). As in Wenzel Jakob's chi2 tests of Nori, Mitsuba
// and pbrt (2012-2024), after Press et al., "Numerical Recipes".
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>

#include "runtime/sampling/sampler.h"

namespace fathom::test {

// One direction, or none; unit vectors.
using DirectionSampler = std::function<std::optional<glm::vec3>(runtime::Sampler& sampler)>;
using DirectionPdf = std::function<double(glm::vec3 direction)>;  // per solid angle

struct ChiSquareSetup {
  int samples = 1000000;
  int rows = 40, columns = 80;  // of polar angle and of azimuth; an even number of rows has the horizon between cells
  glm::vec3 pole{0, 0, 1};
  std::uint64_t seed = 1;
};

struct ChiSquare {
  double p = 0;  // that a true density gives so much deviation or more
  double statistic = 0;
  int freedom = 0;
  double integral = 0;  // of the density, where it was integrated
  std::string describe() const;
};

ChiSquare chi_square(const DirectionSampler& sample, const DirectionPdf& pdf, const ChiSquareSetup& setup = {});

// What fell into cells against what was expected to.
ChiSquare pearson(std::span<const double> counts, std::span<const double> expected);

struct SphereRule {
  glm::vec3 pole{0, 0, 1};
  int rows = 12;  // of twice as many cells
  double tolerance = 1e-6;
  std::optional<double> step;         // polar angle at which the function may jump: a side of cells, too
  std::span<const glm::vec3> guides;  // directions drawn about as the function is large
};
// Of a function of the direction over the sphere, by adaptive rules: a cell is halved both ways until few guides are
// in it, so that no peak hides between the points of a rule, and then until it changes by `tolerance` or less.
double sphere_integral(const DirectionPdf& f, const SphereRule& rule);

// The level that each of `tests` independent tests is held to so that all together have the level alpha (Sidak 1967).
double sidak(double alpha, int tests);

// P(X >= statistic) for X of the chi-square distribution.
double chi_square_tail(double statistic, double freedom);

}  // namespace fathom::test
