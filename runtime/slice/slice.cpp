#include "runtime/slice/slice.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vm/number/decimal.h"

namespace fathom::runtime {
namespace {

// Colours of one side of the surface, sRGB encoded. Blue and orange differ to the colour-blind as much as to anyone.
// Each side becomes fainter with the distance, so that the surface stands out.
struct Shade {
  glm::dvec3 near, far, line;
};
constexpr Shade kInside{{0.13, 0.37, 0.70}, {0.66, 0.80, 0.94}, {0.05, 0.19, 0.42}};
constexpr Shade kOutside{{0.95, 0.62, 0.25}, {1.0, 0.94, 0.84}, {0.66, 0.36, 0.05}};
constexpr glm::dvec3 kSurfaceLine{0.04, 0.04, 0.05};
constexpr glm::dvec3 kNotANumber{1, 0, 1};
constexpr double kSurfaceWidth = 2.4, kBandWidth = 1.2;  // of the lines, pixels
// Slope below which the field counts as flat, in bands per pixel. A distance is some thousand times steeper, so less
// is rounding.
constexpr double kFlat = 1e-5;

class DistanceShader {
 public:
  DistanceShader(const std::vector<float>& field, int width, int height, double step)
      : field_(field), width_(width), height_(height), step_(step) {}

  glm::dvec3 color(int x, int y) const {
    const double d = value(x, y);
    if (std::isnan(d)) return kNotANumber;
    const Shade& shade = d < 0 ? kInside : kOutside;
    const double bands = std::abs(d) / step_;
    // Halfway to the faint colour after four bands.
    glm::dvec3 color = glm::mix(shade.near, shade.far, std::isinf(bands) ? 1.0 : bands / (bands + 4));
    const double slope = slope_per_pixel(x, y);
    const double nearest = std::round(bands);
    // A region that lies entirely at a band's level, as above a floor seen from above, gets no line.
    if (nearest >= 1 && std::isfinite(bands) && slope > kFlat * step_) {
      color = glm::mix(color, shade.line, 0.75 * coverage(std::abs(bands - nearest) * step_, slope, kBandWidth));
    }
    return glm::mix(color, kSurfaceLine, coverage(std::abs(d), slope, kSurfaceWidth));
  }

 private:
  double value(int x, int y) const {
    return static_cast<double>(
        field_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)]);
  }

  // Returns the field's change per pixel, by the larger of the differences to both sides: at a crease the two cancel.
  double slope_per_pixel(int x, int y) const {
    const double here = value(x, y);
    const auto difference = [&](int i, int j) {
      if (i < 0 || j < 0 || i >= width_ || j >= height_) return 0.0;
      const double change = std::abs(value(i, j) - here);
      return std::isfinite(change) ? change : 0.0;
    };
    // Not std::hypot, which is not the same on every processor.
    return glm::length(glm::dvec2(std::max(difference(x - 1, y), difference(x + 1, y)),
                                  std::max(difference(x, y - 1), difference(x, y + 1))));
  }

  // Returns the share of a pixel that a line covers. `away`: from the line's middle to the pixel's, in units of the
  // field.
  static double coverage(double away, double slope, double line_width) {
    if (!(slope > 0)) return away == 0 ? 1 : 0;
    return std::clamp(0.5 * line_width + 0.5 - away / slope, 0.0, 1.0);
  }

  const std::vector<float>& field_;
  int width_, height_;
  double step_;
};

}  // namespace

ByteImage sign_image(const std::vector<float>& field, int width, int height) {
  ByteImage image{width, height, {}};
  image.rgb.reserve(3 * field.size());
  for (const float value : field) image.rgb.insert(image.rgb.end(), 3, value < 0 ? 255 : 0);
  return image;
}

double band_step(double length) {
  const double wanted = length / 10;
  const double power = vm::real::power_of_ten(vm::real::decimal_exponent(wanted));
  const auto factor = [&](double step) { return std::max(step / wanted, wanted / step); };
  double best = power;
  for (const double step : {2 * power, 5 * power, 10 * power}) {
    if (factor(step) < factor(best)) best = step;
  }
  return best;
}

ByteImage distance_image(const std::vector<float>& field, int width, int height, double step) {
  const DistanceShader shader(field, width, height, step);
  ByteImage image{width, height, {}};
  image.rgb.reserve(3 * field.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 color = shader.color(x, y);
      for (int i = 0; i < 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(color[i] * 255 + 0.5));
    }
  }
  return image;
}

}  // namespace fathom::runtime
