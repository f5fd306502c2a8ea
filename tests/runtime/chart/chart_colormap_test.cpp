#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "runtime/chart/colormap.h"
#include "runtime/image/image_io.h"
#include "tests/support/catch.h"

namespace fathom::runtime::chart_colormap_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// CIE 1976 lightness of an sRGB colour, 0 to 100.
double lightness(const Rgb& color) {
  const auto linear = [](std::uint8_t byte) {
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(color[0]) + 0.7152 * linear(color[1]) + 0.0722 * linear(color[2]);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

Rgb pixel(const ByteImage& picture, int x, int y) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
  return {picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
}

TEST_CASE("chart colormap: lightness rises evenly", "[chart]") {
  CHECK(viridis(0) == Rgb{0x44, 0x01, 0x54});
  CHECK(viridis(1) == Rgb{0xfd, 0xe7, 0x25});
  CHECK(viridis(-3) == viridis(0));
  CHECK(viridis(7) == viridis(1));
  const double first = lightness(viridis(0)), last = lightness(viridis(1));
  CHECK(first < 16);
  CHECK(last > 90);
  double before = first;
  for (int i = 1; i <= 100; ++i) {
    const double here = lightness(viridis(i / 100.0));
    CHECK(here > before);
    CHECK(here == Approx(first + (last - first) * i / 100).margin(3));
    before = here;
  }
}

TEST_CASE("chart colormap: values by scale", "[chart]") {
  const ColorScale linear{false, -1, 3}, logarithmic{true, 1, 100};
  CHECK(linear.color(1) == viridis(0.5));
  CHECK(linear.color(0) == viridis(0.25));
  CHECK(linear.color(99) == viridis(1));
  CHECK(logarithmic.color(10) == viridis(0.5));
  CHECK(logarithmic.color(0.01) == viridis(0));
  CHECK(logarithmic.color(0) == kNothing);
  CHECK(logarithmic.color(-2) == kNothing);
  for (const ColorScale& scale : {linear, logarithmic}) {
    CHECK(scale.color(static_cast<double>(kNaN)) == kMissing);
    CHECK(scale.color(std::numeric_limits<double>::infinity()) == viridis(1));
  }
}

TEST_CASE("chart colormap: the scale's ends are round and hold the values", "[chart]") {
  const auto is = [](const ColorScale& scale, double lo, double hi) {
    return scale.lo == Approx(lo).margin(1e-12) && scale.hi == Approx(hi);
  };
  const std::vector<float> values = {3, 41, kNaN, 0, std::numeric_limits<float>::infinity()};
  CHECK(is(scale_for(values, false), 0, 50));
  CHECK(is(scale_for(values, true), 1, 100));
  CHECK(is(scale_for(std::vector<float>{10, 1000}, true), 10, 1000));
  CHECK(is(scale_for(std::vector<float>{10}, true), 10, 100));
  CHECK(is(scale_for(std::vector<float>{-3, 1}, false), -5, 1));
  CHECK(is(scale_for(std::vector<float>{-3, -1}, false), -5, 0));
  for (const std::vector<float>& nothing : {std::vector<float>{}, {0, 0}, {kNaN}}) {
    CHECK(is(scale_for(nothing, false), 0, 1));
    CHECK(is(scale_for(nothing, true), 1, 10));
  }
}

TEST_CASE("chart colormap: a map has its pixels above and the scale below", "[chart]") {
  const int width = 200, height = 3;
  std::vector<float> values(width * height, 10);
  values[0] = 1, values[1] = 100, values[2] = kNaN, values[3] = 0;
  const ColorScale scale = scale_for(values, true);
  const ByteImage map = draw_map(values, width, height, scale);
  CHECK(map.width == width);
  CHECK(map.height == height + kScaleHeight);
  REQUIRE(map.rgb.size() == static_cast<std::size_t>(3 * map.width * map.height));
  CHECK(pixel(map, 0, 0) == viridis(0));
  CHECK(pixel(map, 1, 0) == viridis(1));
  CHECK(pixel(map, 2, 0) == kMissing);
  CHECK(pixel(map, 3, 0) == kNothing);
  CHECK(pixel(map, 4, 0) == viridis(0.5));
  // The strip below has the boxes of `missing` and `nothing`, then all colours from the first to the last.
  std::vector<Rgb> row;
  for (int x = 0; x < width; ++x) row.push_back(pixel(map, x, height + 8));
  CHECK(std::count(row.begin(), row.end(), kMissing) == 18);
  CHECK(std::count(row.begin(), row.end(), kNothing) == 18);
  CHECK(std::count(row.begin(), row.end(), viridis(0)) >= 1);
  CHECK(std::set<Rgb>(row.begin(), row.end()).size() > 100);
  CHECK(row[width - 9] == viridis(1));
  CHECK_FALSE(encode_image(map, ImageFormat::Png).empty());
}

TEST_CASE("chart colormap: narrow maps keep their scale, bad sizes are said", "[chart]") {
  for (const int width : {1, 2, 17, 159}) {
    const std::vector<float> values(static_cast<std::size_t>(width), 1);
    const ByteImage map = draw_map(values, width, 1, scale_for(values, false));
    CHECK(map.width == width);
    CHECK(map.height == 1 + kScaleHeight);
  }
  CHECK_THROWS_WITH(draw_map(std::vector<float>(5, 1), 2, 3, {}), "a map of 2 x 3 pixels cannot have 5 values");
  CHECK_THROWS_AS(draw_map({}, 0, 0, {}), std::invalid_argument);
}

}  // namespace
}  // namespace fathom::runtime::chart_colormap_test
