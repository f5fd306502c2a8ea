// The reasons for the samplers: how fast the error falls, and how small it is when pixels are averaged.
#include "tests/support/catch.h"
#include "tests/support/sampling_error.h"

#include <array>
#include <cmath>

namespace fathom::runtime::sampling_error_test {
namespace {

constexpr std::array<int, 9> kPowersOfTwo = {16, 32, 64, 128, 256, 512, 1024, 2048, 4096};

double slope(SamplerKind kind, int integrand, int bounce) {
  const auto& f = test::square_integrands()[static_cast<std::size_t>(integrand)];
  return test::error_slope(test::sampling_errors(kind, f, kPowersOfTwo, 160, bounce));
}

TEST_CASE("sampling error: independent samples err with the root of their number", "[sampling]") {
  for (int f = 0; f < 3; ++f) {
    CAPTURE(f);
    CHECK(slope(SamplerKind::Independent, f, -1) == Approx(-0.5).margin(0.05));
  }
}

TEST_CASE("sampling error: Sobol's points err much less the more there are, in every pair of dimensions",
          "[sampling]") {
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Blue}) {
    for (const int bounce : {-1, 7}) {
      CAPTURE(kind, bounce);
      CHECK(slope(kind, 0, bounce) <= -1.2);
      CHECK(slope(kind, 1, bounce) <= -0.7);
      CHECK(slope(kind, 2, bounce) <= -0.7);
    }
  }
}

TEST_CASE("sampling error: numbers of samples that are no powers of two are good, too", "[sampling]") {
  constexpr std::array<int, 6> kCounts = {12, 24, 48, 100, 200, 400};
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Blue}) {
    for (const test::SquareIntegrand& f : test::square_integrands()) {
      const int repeats = 800;
      const auto stratified = test::sampling_errors(kind, f, kCounts, repeats, -1);
      const auto independent = test::sampling_errors(SamplerKind::Independent, f, kCounts, repeats, -1);
      for (std::size_t i = 0; i < kCounts.size(); ++i) {
        CAPTURE(kind, std::string(f.name), kCounts[i], stratified[i].rmse, independent[i].rmse);
        CHECK(stratified[i].rmse < (kCounts[i] < 48 ? 0.75 : 0.55) * independent[i].rmse);
      }
    }
  }
}

TEST_CASE("sampling error: of the kind blue little is left where pixels are seen together", "[sampling]") {
  const int side = 64, seeds = 8;
  for (const test::SquareIntegrand& f : test::square_integrands()) {
    for (const int spp : {1, 2, 4, 16}) {
      for (const int bounce : {-1, 5}) {
        CAPTURE(std::string(f.name), spp, bounce);
        CHECK(test::low_frequency_power(SamplerKind::Blue, f, spp, side, seeds, bounce) < 0.6);
      }
    }
    CHECK(test::low_frequency_power(SamplerKind::Blue, f, 3, side, seeds, -1) < 1);
    CHECK(test::low_frequency_power(SamplerKind::Sobol, f, 1, side, seeds, -1) == Approx(1).margin(0.2));
  }
}

// This shows that `blue` costs nothing for single pixels and can be the default.
TEST_CASE("sampling error: a pixel by itself errs with the kind blue as with sobol", "[sampling]") {
  constexpr std::array<int, 5> kCounts = {1, 2, 4, 8, 16};
  for (const test::SquareIntegrand& f : test::square_integrands()) {
    for (const int count : kCounts) {
      // The number of samples equals the planned number, as in a render.
      const std::array<int, 1> counts = {count};
      const int repeats = 10000;
      const double blue = test::sampling_errors(SamplerKind::Blue, f, counts, repeats, -1)[0].rmse;
      const double sobol = test::sampling_errors(SamplerKind::Sobol, f, counts, repeats, -1)[0].rmse;
      CAPTURE(std::string(f.name), count, blue, sobol);
      CHECK(blue < 1.1 * sobol);
    }
  }
}

}  // namespace
}  // namespace fathom::runtime::sampling_error_test
