#include "runtime/sampler.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

namespace fathom::runtime {
namespace {

TEST_CASE("sampler: a function of its key alone", "[runtime]") {
  Sampler first(7, 3, 4, 5), again(7, 3, 4, 5);
  for (int i = 0; i < 100; ++i) CHECK(first.next() == again.next());
}

TEST_CASE("sampler: every part of the key matters", "[runtime]") {
  std::set<float> seen;
  for (Sampler s : {Sampler(0, 0, 0, 0), Sampler(1, 0, 0, 0), Sampler(0, 1, 0, 0), Sampler(0, 0, 1, 0),
                    Sampler(0, 0, 0, 1), Sampler(1ull << 63, 0, 0, 0)}) {
    seen.insert(s.next());
  }
  CHECK(seen.size() == 6);
}

// Chi-square over a 16 x 16 grid with 255 degrees of freedom: mean 255, standard deviation sqrt(510).
double chi_square(const std::vector<int>& counts, double expected) {
  double sum = 0;
  for (int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

TEST_CASE("sampler: pairs are even, over dimensions and over neighbouring pixels", "[runtime]") {
  const int n = 1 << 18;
  std::vector<int> along(256), across(256), samples(256);
  for (int i = 0; i < n; ++i) {
    const std::uint32_t x = static_cast<std::uint32_t>(i % 512), y = static_cast<std::uint32_t>(i / 512);
    Sampler sampler(0, x, y, 0), neighbour(0, x + 1, y, 0), later(0, x, y, 1);
    const float a = sampler.next();
    const auto cell = [&](float b) {
      return static_cast<std::size_t>(a * 16) * 16 + static_cast<std::size_t>(b * 16);
    };
    ++along[cell(sampler.next())];
    ++across[cell(neighbour.next())];
    ++samples[cell(later.next())];
  }
  const double limit = 255 + 4 * std::sqrt(510.0);
  CHECK(chi_square(along, n / 256.0) < limit);
  CHECK(chi_square(across, n / 256.0) < limit);
  CHECK(chi_square(samples, n / 256.0) < limit);
}

TEST_CASE("sampler: numbers lie from 0 up to, but not at, 1", "[runtime]") {
  Sampler sampler(1, 2, 3, 4);
  for (int i = 0; i < 1 << 20; ++i) {
    const float u = sampler.next();
    if (!(u >= 0 && u < 1)) FAIL("out of range: " << u);
  }
}

}  // namespace
}  // namespace fathom::runtime
