#include "runtime/image.h"

#include <catch2/catch.hpp>

#include "runtime/elementary.h"

namespace fathom::runtime {
namespace {

// Two pixels: one grey hit at depth 2 and 4 each, and one pixel that saw nothing.
Film three_pixels() {
  Film film(3, 1);
  PathSample sample;
  sample.radiance = glm::vec3(0.25f);
  sample.hit = true;
  sample.albedo = glm::vec3(1, 0, 0.5f);
  sample.normal = glm::vec3(0, 1, 0);
  sample.depth = 2;
  film.add(0, 0, sample);
  sample.depth = 4;
  film.add(1, 0, sample);
  film.add(2, 0, {});
  return film;
}

TEST_CASE("image: beauty is exposed, sRGB encoded and clamped", "[runtime]") {
  const Film film = three_pixels();
  CHECK(beauty_picture(film, 0).rgb[0] == 137);  // 0.25
  CHECK(beauty_picture(film, 1).rgb[0] == 188);  // 0.5
  CHECK(beauty_picture(film, 2).rgb[0] == 255);  // 1
  CHECK(beauty_picture(film, 10).rgb[0] == 255);
  CHECK(beauty_picture(film, 10).rgb[6] == 0);
}

TEST_CASE("image: every brightness is the nearest byte of its sRGB signal", "[runtime]") {
  constexpr int kSide = 512;
  Film film(kSide, kSide);
  PathSample sample;
  for (int i = 0; i < kSide * kSide; ++i) {
    sample.radiance = glm::vec3(static_cast<float>(i) / (kSide * kSide - 1));
    film.add(i % kSide, i / kSide, sample);
  }
  const Picture picture = beauty_picture(film, 0);
  int wrong = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double light = film.means(i % kSide, i / kSide).radiance.x;
    wrong += picture.rgb[static_cast<std::size_t>(3 * i)] != static_cast<int>(srgb_encode(light) * 255 + 0.5);
  }
  CHECK(wrong == 0);
}

TEST_CASE("image: what lies first along the ray", "[runtime]") {
  const Film film = three_pixels();
  const Picture albedo = albedo_picture(film), normal = normal_picture(film), depth = depth_picture(film);
  CHECK(albedo.rgb == std::vector<std::uint8_t>{255, 0, 188, 255, 0, 188, 0, 0, 0});
  CHECK(normal.rgb == std::vector<std::uint8_t>{128, 255, 128, 128, 255, 128, 0, 0, 0});
  CHECK(depth.rgb == std::vector<std::uint8_t>{255, 255, 255, 128, 128, 128, 0, 0, 0});
}

}  // namespace
}  // namespace fathom::runtime
