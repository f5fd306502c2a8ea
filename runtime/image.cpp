#include "runtime/image.h"

#include <algorithm>
#include <array>
#include <limits>

#include "runtime/elementary.h"

namespace fathom::runtime {
namespace {

// [0,1] to 0..255, nearest; outside values to the ends, NaN to 0.
std::uint8_t to_byte(double value) {
  if (!(value > 0)) return 0;
  return static_cast<std::uint8_t>(std::min(value, 1.0) * 255 + 0.5);
}

// Linear light to the nearest byte of its sRGB signal, by the least light that each byte stands for: comparing is
// several times faster than the root that srgb_encode() takes.
class SrgbBytes {
 public:
  SrgbBytes() {
    for (std::size_t i = 0; i < least_.size(); ++i) least_[i] = least_of(static_cast<int>(i) + 1);
  }
  std::uint8_t operator()(double linear) const {
    if (!(linear > 0)) return 0;
    return static_cast<std::uint8_t>(std::upper_bound(least_.begin(), least_.end(), linear) - least_.begin());
  }

 private:
  static double least_of(int byte) {
    double below = 0, enough = 1;
    while (true) {
      const double middle = (below + enough) / 2;
      if (middle <= below || middle >= enough) return enough;
      (to_byte(srgb_encode(middle)) >= byte ? enough : below) = middle;
    }
  }

  std::array<double, 255> least_;  // [byte - 1]
};

// Shade: PixelMeans -> colour; Encode: a component of it -> byte.
template <typename Shade, typename Encode>
Picture make_picture(const Film& film, const Shade& shade, const Encode& encode) {
  Picture picture{film.width(), film.height(), {}};
  picture.rgb.reserve(static_cast<std::size_t>(film.width()) * static_cast<std::size_t>(film.height()) * 3);
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const glm::dvec3 color = shade(film.means(x, y));
      for (int i = 0; i < 3; ++i) picture.rgb.push_back(encode(color[i]));
    }
  }
  return picture;
}

}  // namespace

Picture beauty_picture(const Film& film, double exposure) {
  const double factor = static_cast<double>(exp2(static_cast<float>(std::clamp(exposure, -100.0, 100.0))));
  return make_picture(
      film, [&](const PixelMeans& pixel) { return pixel.radiance * factor; }, SrgbBytes());
}

Picture albedo_picture(const Film& film) {
  return make_picture(
      film, [](const PixelMeans& pixel) { return pixel.albedo; }, SrgbBytes());
}

Picture normal_picture(const Film& film) {
  return make_picture(
      film,
      [](const PixelMeans& pixel) {
        if (pixel.hits == 0) return glm::dvec3(0);
        const double all_to_hits = static_cast<double>(pixel.samples) / pixel.hits;
        return pixel.normal * all_to_hits * 0.5 + 0.5;
      },
      to_byte);
}

Picture depth_picture(const Film& film) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const PixelMeans pixel = film.means(x, y);
      if (pixel.hits > 0) nearest = std::min(nearest, pixel.depth);
    }
  }
  return make_picture(
      film,
      [&](const PixelMeans& pixel) {
        return glm::dvec3(pixel.hits > 0 && pixel.depth > 0 ? nearest / pixel.depth : 0);
      },
      to_byte);
}

}  // namespace fathom::runtime
