#include "runtime/image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compiler/scene/srgb.h"

namespace fathom::runtime {
namespace {

// Maps [0,1] to 0..Most, nearest. Values outside go to the ends, NaN to 0.
template <typename Word>
Word to_whole(double value) {
  if (!(value > 0)) return 0;
  return static_cast<Word>(std::min(value, 1.0) * std::numeric_limits<Word>::max() + 0.5);
}

// Maps linear light to the nearest byte of its sRGB signal, by the least light that each byte stands for. Comparing
// is several times faster than the root in srgb_encode().
class SrgbBytes {
 public:
  SrgbBytes() {
    for (std::size_t i = 0; i < least_.size(); ++i) least_[i] = min_of(static_cast<int>(i) + 1);
  }
  std::uint8_t operator()(double linear) const {
    if (!(linear > 0)) return 0;
    return static_cast<std::uint8_t>(std::upper_bound(least_.begin(), least_.end(), linear) - least_.begin());
  }

 private:
  static double min_of(int byte) {
    double below = 0, enough = 1;
    while (true) {
      const double middle = (below + enough) / 2;
      if (middle <= below || middle >= enough) return enough;
      (to_whole<std::uint8_t>(compiler::srgb_encode(middle)) >= byte ? enough : below) = middle;
    }
  }

  std::array<double, 255> least_;  // [byte - 1]
};

// Returns the smallest depth of all hits; infinite when there are no hits. The depth of a miss is 0.
double nearest_of(const LayerValues& depth) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int y = depth.area.y0; y < depth.area.y1; ++y) {
    for (int x = depth.area.x0; x < depth.area.x1; ++x) {
      const double here = static_cast<double>(depth.at(x, y).x);
      if (here > 0) nearest = std::min(nearest, here);
    }
  }
  return nearest;
}

}  // namespace

std::optional<LayerValues> layer_of(const FloatImage& image, Layer layer) {
  std::array<const std::vector<float>*, 3> channels;
  for (std::size_t i = 0; i < 3; ++i) {
    channels[i] = image.channel(info(layer).channels[i]);
    if (channels[i] == nullptr) return std::nullopt;
  }
  return LayerValues{layer, image.area, [channels, area = image.area](int x, int y) {
                       const std::size_t at = area.index(x, y);
                       return glm::vec3((*channels[0])[at], (*channels[1])[at], (*channels[2])[at]);
                     }};
}

std::optional<std::string> not_finite(const LayerValues& values) {
  std::size_t undefined = 0, infinite = 0;
  std::string first;
  for (int y = values.area.y0; y < values.area.y1; ++y) {
    for (int x = values.area.x0; x < values.area.x1; ++x) {
      const glm::vec3 value = values.at(x, y);
      const bool is_nan = std::isnan(value.x) || std::isnan(value.y) || std::isnan(value.z);
      if (!is_nan && std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z)) continue;
      if (first.empty()) first = fmt::format("the first in column {} of row {}", x, y);
      ++(is_nan ? undefined : infinite);
    }
  }
  if (first.empty()) return std::nullopt;
  std::string text;
  for (const auto& [count, what] : {std::pair{undefined, "NaN"}, {infinite, "infinity"}}) {
    if (count == 0) continue;
    text += fmt::format("{}{} pixel{} with {}", text.empty() ? "" : " and ", count, count == 1 ? "" : "s", what);
  }
  return fmt::format("{}, {}", text, first);
}

DisplayImage::DisplayImage(LayerValues values, ToneMapping tone)
    : values_(std::move(values)),
      encoded_(is_light(values_.layer) || values_.layer == Layer::Albedo),
      curve_(tone.curve),
      factor_(exposure_factor(tone.exposure)) {
  if (values_.layer == Layer::Depth) nearest_ = nearest_of(values_);
}

glm::dvec3 DisplayImage::color(int x, int y) const {
  const glm::dvec3 value(values_.at(x, y));
  switch (values_.layer) {
    case Layer::Beauty:
    case Layer::Noisy:
      return apply_curve(curve_, value * factor_);
    case Layer::Albedo:
      break;
    case Layer::Depth:
      return glm::dvec3(value.x > 0 ? nearest_ / value.x : 0);
    case Layer::Normal:
      return value == glm::dvec3(0) ? value : value * 0.5 + 0.5;
  }
  return value;
}

void DisplayImage::row(int y, std::span<std::uint8_t> rgb) const {
  static const SrgbBytes to_srgb;
  auto out = rgb.begin();
  for (int x = values_.area.x0; x < values_.area.x1; ++x) {
    const glm::dvec3 display = color(x, y + values_.area.y0);
    for (int i = 0; i < 3; ++i) *out++ = encoded_ ? to_srgb(display[i]) : to_whole<std::uint8_t>(display[i]);
  }
}

void DisplayImage::row(int y, std::span<std::uint16_t> rgb) const {
  auto out = rgb.begin();
  for (int x = values_.area.x0; x < values_.area.x1; ++x) {
    const glm::dvec3 display = color(x, y + values_.area.y0);
    for (int i = 0; i < 3; ++i)
      *out++ = to_whole<std::uint16_t>(encoded_ ? compiler::srgb_encode(display[i]) : display[i]);
  }
}

ByteImage to_byte_image(const DisplayImage& display) {
  const std::size_t row = static_cast<std::size_t>(display.width()) * 3;
  ByteImage image{display.width(), display.height(), {}};
  image.rgb.resize(row * static_cast<std::size_t>(display.height()));
  for (int y = 0; y < display.height(); ++y) {
    display.row(y, std::span(image.rgb).subspan(static_cast<std::size_t>(y) * row, row));
  }
  return image;
}

}  // namespace fathom::runtime
