// Estimates the mean radiance of an image of uniform brightness, with its standard error.
#pragma once

#include <algorithm>
#include <cmath>

#include "runtime/film/film.h"

namespace fathom::runtime {

struct Estimate {
  double mean, sigma;  // sigma: standard error of the mean over the whole image
};

// Red radiance over all pixels. sigma comes from the spread between pixels, which are independent.
inline Estimate estimate(const Film& film) {
  double sum = 0, squares = 0;
  const double n = static_cast<double>(film.width()) * film.height();
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const double value = film.means(x, y).radiance.x;
      sum += value;
      squares += value * value;
    }
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

}  // namespace fathom::runtime
