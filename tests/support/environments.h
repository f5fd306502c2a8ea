// Backgrounds that the renderer samples by tables: a sky without its sun, and an image in which all pixels differ.
#pragma once

#include <memory>

#include "runtime/light/environment_file.h"
#include "runtime/sampling/sampler.h"

namespace fathom::test {

inline std::shared_ptr<runtime::EnvironmentImage> random_image(int width, int height) {
  auto image = std::make_shared<runtime::EnvironmentImage>(runtime::EnvironmentImage{width, height, {}});
  for (int i = 0; i < width * height; ++i) {
    runtime::Sampler s(9, static_cast<std::uint32_t>(i), 0, 0);
    const float bright = i % 17 == 3 ? 5.0f : 0.5f;
    image->pixels.emplace_back(bright * s.next(), bright * s.next(), bright * s.next());
  }
  return image;
}

inline constexpr const char* kSky = R"("background": {"type": "sky", "elevation": 35, "azimuth": 50, "turbidity": 4,
    "sun_disc": false})";
// Environment map whose file is never read: tests use random_image() instead.
inline constexpr const char* kPicture = R"("background": {"type": "image", "file": ")" FATHOM_SOURCE_DIR
                                        R"(/tests/data/one-pixel.hdr", "rotate": 40, "strength": 2})";

}  // namespace fathom::test
