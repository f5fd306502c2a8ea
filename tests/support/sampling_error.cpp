#include "tests/support/sampling_error.h"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace fathom::test {
namespace {

// Samples are multiples of 2^-24, and each stands for the middle of its interval. Coordinates are in double.
constexpr double kHalfStep = 0x1p-25;

// Returns e^(-x) sin(pi y), whose integral is (1 - 1/e) * 2/pi.
double smooth(glm::vec2 u) {
  const double x = static_cast<double>(u.x) + kHalfStep, y = static_cast<double>(u.y) + kHalfStep;
  return std::exp(-x) * std::sin(std::numbers::pi * y);
}
double edge(glm::vec2 u) {
  return static_cast<double>(u.y) + kHalfStep < 0.2 + 0.5 * (static_cast<double>(u.x) + kHalfStep) ? 1 : 0;
}
double disc(glm::vec2 u) {
  const double x = static_cast<double>(u.x) + kHalfStep - 0.5, y = static_cast<double>(u.y) + kHalfStep - 0.5;
  return x * x + y * y < 0.16 ? 1 : 0;
}

constexpr SquareIntegrand kIntegrands[] = {
    {"smooth", smooth, (1 - 1 / std::numbers::e) * 2 / std::numbers::pi},
    {"straight edge", edge, 0.45},
    {"disc", disc, 0.16 * std::numbers::pi},
};

glm::vec2 draw(const runtime::PixelKey& pixel, std::uint32_t sample, int bounce) {
  runtime::Sampler sampler(pixel, sample);
  if (bounce >= 0) sampler.start_bounce(bounce);
  return sampler.next2();
}

// Returns the error of each pixel. [y * side + x]
std::vector<double> error_image(const runtime::SamplePlan& plan, const SquareIntegrand& integrand, int side,
                                int bounce) {
  std::vector<double> errors;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const runtime::PixelKey pixel(plan, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
      double sum = 0;
      for (int i = 0; i < plan.spp; ++i) sum += integrand.value(draw(pixel, static_cast<std::uint32_t>(i), bounce));
      errors.push_back(sum / plan.spp - integrand.integral);
    }
  }
  return errors;
}

// Returns the mean power of the coefficients of the image's discrete Fourier transform with at most `max` periods,
// except the constant. For all coefficients the mean would be the sum of the squares over their number. Transforms
// rows first, then columns. Half of the plane is enough, because the image is real and the other half mirrors it.
double mean_power(const std::vector<double>& image, int side, int max) {
  using Complex = std::complex<double>;
  std::vector<Complex> wave;  // [i] e^(2 pi i / side)
  for (int i = 0; i < side; ++i) wave.push_back(std::polar(1.0, 2 * std::numbers::pi * i / side));
  const auto wave_at = [&](int i) { return wave[static_cast<std::size_t>((i % side + side) % side)]; };
  double sum = 0;
  int count = 0;
  for (int kx = 0; kx <= max; ++kx) {
    std::vector<Complex> rows(static_cast<std::size_t>(side));
    for (int i = 0; i < side * side; ++i) {
      rows[static_cast<std::size_t>(i / side)] += image[static_cast<std::size_t>(i)] * wave_at(kx * (i % side));
    }
    for (int ky = kx == 0 ? 1 : -max; ky <= max; ++ky) {
      if (kx * kx + ky * ky > max * max) continue;
      Complex coefficient = 0;
      for (int y = 0; y < side; ++y) coefficient += rows[static_cast<std::size_t>(y)] * wave_at(ky * y);
      sum += std::norm(coefficient) / (side * side);
      ++count;
    }
  }
  return sum / count;
}

}  // namespace

std::span<const SquareIntegrand> square_integrands() { return kIntegrands; }

std::vector<SamplingError> sampling_errors(runtime::SamplerKind kind, const SquareIntegrand& integrand,
                                           std::span<const int> counts, int repeats, int bounce) {
  std::vector<SamplingError> errors;
  for (const int count : counts) errors.push_back({count, 0});
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto place = static_cast<std::uint32_t>(repeat);
    const runtime::PixelKey pixel({kind, place + 1, counts.back()}, place * 7, place * 5);
    double sum = 0;
    int drawn = 0;
    for (SamplingError& error : errors) {
      for (; drawn < error.samples; ++drawn) {
        sum += integrand.value(draw(pixel, static_cast<std::uint32_t>(drawn), bounce));
      }
      const double off = sum / drawn - integrand.integral;
      error.rmse += off * off;
    }
  }
  for (SamplingError& error : errors) error.rmse = std::sqrt(error.rmse / repeats);
  return errors;
}

double error_slope(std::span<const SamplingError> errors) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(errors.size());
  for (const SamplingError& error : errors) {
    const double a = std::log(error.samples), b = std::log(error.rmse);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (xy - x * y / n) / (xx - x * x / n);
}

double low_frequency_power(runtime::SamplerKind kind, const SquareIntegrand& integrand, int spp, int side, int seeds,
                           int bounce) {
  double low = 0, all = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const runtime::SamplePlan plan{kind, static_cast<std::uint64_t>(seed) + 1, spp};
    const std::vector<double> image = error_image(plan, integrand, side, bounce);
    low += mean_power(image, side, side / 8);
    for (const double error : image) all += error * error / (side * side);
  }
  return low / all;
}

}  // namespace fathom::test
