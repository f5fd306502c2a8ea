#include "runtime/image/image_diff.h"

#include <algorithm>
#include <cmath>

#include "vm/program/check.h"

namespace fathom::runtime {

Differences compare(RgbView image, RgbView reference) {
  CHECK(image.width == reference.width && image.height == reference.height, "pictures of different sizes");
  const std::size_t pixels = image.rgb.size() / 3;
  Differences sum;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    double a[3], b[3];
    bool finite = true;
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = static_cast<double>(image.rgb[3 * pixel + i]);
      b[i] = static_cast<double>(reference.rgb[3 * pixel + i]);
      finite &= std::isfinite(a[i]) && std::isfinite(b[i]);
    }
    if (!finite) {
      ++sum.invalid;
      continue;
    }
    for (int i = 0; i < 3; ++i) {
      const double difference = a[i] - b[i], square = difference * difference;
      sum.mse += square;
      sum.relmse += square / (b[i] * b[i] + kRelMseEpsilon);
      sum.mean += difference;
      sum.max = std::max(sum.max, std::abs(difference));
    }
  }
  const double values = 3 * static_cast<double>(pixels - sum.invalid);
  if (values == 0) return sum;
  sum.mse /= values;
  sum.relmse /= values;
  sum.mean /= values;
  return sum;
}

}  // namespace fathom::runtime
