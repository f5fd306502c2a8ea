// Pearson's chi-square test: are directions sampled with the density that a sampler claims?
//
// The sphere is cut into cells of polar angle and azimuth. The test integrates the density over each cell (adaptive
// Gauss rule, in double) and compares the integral with the number of samples in the cell. Cells that expect fewer
// than 5 samples are pooled. A density may integrate to less than 1, so failed samples count as one more cell. A
// discontinuity of the density must run along cell boundaries: the adaptive rule may miss a small corner that the
// discontinuity cuts off a cell, and stop (the rim of a disc across cells of 4.5 degrees cost 4e-5 of the disc's
// integral, which a million samples show).
//
// Sources: Wenzel Jakob's chi2 tests in Nori, Mitsuba and pbrt (2012-2024); Press et al., "Numerical Recipes".
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>

#include "runtime/sampling/sampler.h"

namespace fathom::test {

// Returns a unit vector, or nullopt when sampling fails.
using DirectionSampler = std::function<std::optional<glm::vec3>(runtime::Sampler& sampler)>;
using DirectionPdf = std::function<double(glm::vec3 direction)>;  // per unit solid angle

struct ChiSquareSetup {
  int samples = 1000000;
  // Cells in polar angle and in azimuth. With an even number of rows the horizon lies between two rows.
  int rows = 40, columns = 80;
  glm::vec3 pole{0, 0, 1};
  std::uint64_t seed = 1;
};

struct ChiSquare {
  double p = 0;  // probability of at least this deviation if the density is correct
  double statistic = 0;
  int freedom = 0;
  double integral = 0;  // integral of the density over all cells; 0 from pearson(), which sees no density
  std::string describe() const;
};

ChiSquare chi_square(const DirectionSampler& sample, const DirectionPdf& pdf, const ChiSquareSetup& setup = {});

// Compares the counts of samples per cell with the expected counts.
ChiSquare pearson(std::span<const double> counts, std::span<const double> expected);

struct SphereRule {
  glm::vec3 pole{0, 0, 1};
  int rows = 12;  // rows of cells in polar angle; each row has twice as many cells
  double tolerance = 1e-6;
  std::optional<double> step;         // polar angle at which the function may jump; also a cell boundary
  std::span<const glm::vec3> guides;  // directions distributed roughly like the function
};
// Integral over the sphere of a function of the direction, by an adaptive rule. A cell is quartered until it holds
// few guides, so that no peak hides between the rule's points, and then until quartering changes the cell's integral
// by `tolerance` or less.
double sphere_integral(const DirectionPdf& f, const SphereRule& rule);

// Significance level for each of `tests` independent tests such that together they have the level alpha (Sidak 1967).
double sidak(double alpha, int tests);

// P(X >= statistic) for X of the chi-square distribution with `freedom` degrees of freedom.
double chi_square_tail(double statistic, double freedom);

}  // namespace fathom::test
