#include "runtime/image.h"

#include <algorithm>
#include <limits>

#include "runtime/elementary.h"

namespace fathom::runtime {
namespace {

// [0,1] to 0..255, nearest; outside values to the ends, NaN to 0.
std::uint8_t to_byte(double value) {
  if (!(value > 0)) return 0;
  return static_cast<std::uint8_t>(std::min(value, 1.0) * 255 + 0.5);
}

template <typename Shade>  // PixelMeans -> colour in [0,1]^3, as shown
Picture make_picture(const Film& film, Shade shade) {
  Picture picture{film.width(), film.height(), {}};
  picture.rgb.reserve(static_cast<std::size_t>(film.width()) * static_cast<std::size_t>(film.height()) * 3);
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const glm::dvec3 color = shade(film.means(x, y));
      for (int i = 0; i < 3; ++i) picture.rgb.push_back(to_byte(color[i]));
    }
  }
  return picture;
}

glm::dvec3 encode(glm::dvec3 linear) { return {srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z)}; }

}  // namespace

Picture beauty_picture(const Film& film, double exposure) {
  const double factor = static_cast<double>(exp2(static_cast<float>(std::clamp(exposure, -100.0, 100.0))));
  return make_picture(film, [&](const PixelMeans& pixel) { return encode(pixel.radiance * factor); });
}

Picture albedo_picture(const Film& film) {
  return make_picture(film, [](const PixelMeans& pixel) { return encode(pixel.albedo); });
}

Picture normal_picture(const Film& film) {
  return make_picture(film, [](const PixelMeans& pixel) {
    if (pixel.hits == 0) return glm::dvec3(0);
    const double all_to_hits = static_cast<double>(pixel.samples) / pixel.hits;
    return pixel.normal * all_to_hits * 0.5 + 0.5;
  });
}

Picture depth_picture(const Film& film) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const PixelMeans pixel = film.means(x, y);
      if (pixel.hits > 0) nearest = std::min(nearest, pixel.depth);
    }
  }
  return make_picture(film, [&](const PixelMeans& pixel) {
    return glm::dvec3(pixel.hits > 0 && pixel.depth > 0 ? nearest / pixel.depth : 0);
  });
}

}  // namespace fathom::runtime
