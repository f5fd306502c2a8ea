// Measures how fast a sampler's error falls with the number of samples, and how the error is spread over the pixels.
//
// The errors are those of integrals over the unit square that are known in closed form.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/sampling/sampler.h"

namespace fathom::test {

struct SquareIntegrand {
  std::string_view name;
  double (*value)(glm::vec2 u);
  double integral;
};
// Returns the integrands smooth, straight edge and disc.
std::span<const SquareIntegrand> square_integrands();

struct SamplingError {
  int samples;
  double rmse;
};

// Returns the errors after each of `counts` samples, in ascending order, over `repeats` pixels with seeds of their
// own. The samples are the first pair of the bounce, or the first pair of all when `bounce` is -1.
std::vector<SamplingError> sampling_errors(runtime::SamplerKind kind, const SquareIntegrand& integrand,
                                           std::span<const int> counts, int repeats, int bounce);

// Returns the exponent of the power law through the errors, by least squares in logarithms; -0.5 if samples are
// independent.
double error_slope(std::span<const SamplingError> errors);

// Returns how the errors of a square image of one integrand, `side` pixels and `spp` samples, are spread over
// frequencies: the mean power of frequencies of at most side/8 periods, over the mean power of all. White noise has
// 1. Mean over `seeds`.
double low_frequency_power(runtime::SamplerKind kind, const SquareIntegrand& integrand, int spp, int side, int seeds,
                           int bounce);

}  // namespace fathom::test
