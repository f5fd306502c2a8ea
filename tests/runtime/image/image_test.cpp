#include "runtime/image/image.h"

#include <algorithm>
#include <cmath>

#include "compiler/scene/srgb.h"
#include "runtime/film/film_layers.h"
#include "tests/support/catch.h"

namespace fathom::runtime::image_test {
namespace {

// Two grey pixels that hit at depth 2 and 4, and a pixel without a hit.
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

TEST_CASE("image: beauty is exposed, sRGB encoded and clamped", "[image]") {
  const Film film = three_pixels();
  CHECK(layer_image(film, Layer::Beauty).rgb[0] == 137);       // 0.25
  CHECK(layer_image(film, Layer::Beauty, {1}).rgb[0] == 188);  // 0.5
  CHECK(layer_image(film, Layer::Beauty, {2}).rgb[0] == 255);  // 1
  CHECK(layer_image(film, Layer::Beauty, {10}).rgb[0] == 255);
  CHECK(layer_image(film, Layer::Beauty, {10}).rgb[6] == 0);
}

TEST_CASE("image: every brightness is the nearest byte of its sRGB signal", "[image]") {
  constexpr int kSide = 512;
  Film film(kSide, kSide);
  PathSample sample;
  for (int i = 0; i < kSide * kSide; ++i) {
    sample.radiance = glm::vec3(static_cast<float>(i) / (kSide * kSide - 1));
    film.add(i % kSide, i / kSide, sample);
  }
  const ByteImage picture = layer_image(film, Layer::Beauty);
  int wrong = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double light = film.means(i % kSide, i / kSide).radiance.x;
    wrong +=
        picture.rgb[static_cast<std::size_t>(3 * i)] != static_cast<int>(compiler::srgb_encode(light) * 255 + 0.5);
  }
  CHECK(wrong == 0);
}

TEST_CASE("image: what lies first along the ray", "[image]") {
  const Film film = three_pixels();
  const ByteImage albedo = layer_image(film, Layer::Albedo), normal = layer_image(film, Layer::Normal),
                  depth = layer_image(film, Layer::Depth);
  CHECK(albedo.rgb == std::vector<std::uint8_t>{255, 0, 188, 255, 0, 188, 0, 0, 0});
  CHECK(normal.rgb == std::vector<std::uint8_t>{128, 255, 128, 128, 255, 128, 0, 0, 0});
  CHECK(depth.rgb == std::vector<std::uint8_t>{255, 255, 255, 128, 128, 128, 0, 0, 0});
}

TEST_CASE("image: 16 bits are the nearest word, and 8 bits the same picture", "[image]") {
  constexpr int kWidth = 4096;
  Film film(kWidth, 1);
  PathSample sample;
  for (int i = 0; i < kWidth; ++i) {
    sample.radiance = glm::vec3(static_cast<float>(i) / (kWidth - 1));
    film.add(i, 0, sample);
  }
  const DisplayImage shown(layer_of(film, Layer::Beauty), {1, ToneCurve::Filmic});
  std::vector<std::uint16_t> words(3 * kWidth);
  std::vector<std::uint8_t> bytes(3 * kWidth);
  shown.row(0, words);
  shown.row(0, bytes);
  int wrong = 0, apart = 0;
  for (int i = 0; i < kWidth; ++i) {
    const std::size_t at = static_cast<std::size_t>(3 * i);
    const double light = apply_curve(ToneCurve::Filmic, glm::dvec3(2 * film.means(i, 0).radiance.x)).x;
    wrong += words[at] != static_cast<int>(compiler::srgb_encode(light) * 65535 + 0.5);
    apart += std::abs(words[at] / 257.0 - bytes[at]) > 0.501;
  }
  CHECK(wrong == 0);
  CHECK(apart == 0);
}

TEST_CASE("image: a part of a picture is shown as that part", "[image]") {
  Film whole(8, 6), part(PixelRect{2, 1, 7, 5});
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      PathSample sample;
      sample.radiance = glm::vec3(static_cast<float>(x) / 8, static_cast<float>(y) / 6, 0.5f);
      whole.add(x, y, sample);
      if (x >= 2 && x < 7 && y >= 1 && y < 5) part.add(x, y, sample);
    }
  }
  const ByteImage all = layer_image(whole, Layer::Beauty), some = layer_image(part, Layer::Beauty);
  REQUIRE(some.width == 5);
  REQUIRE(some.height == 4);
  for (std::size_t y = 0; y < 4; ++y) {
    const auto row = all.rgb.begin() + static_cast<std::ptrdiff_t>(3 * ((y + 1) * 8 + 2));
    CHECK(std::equal(row, row + 15, some.rgb.begin() + static_cast<std::ptrdiff_t>(15 * y)));
  }
}

}  // namespace
}  // namespace fathom::runtime::image_test
