#include "runtime/image/flip.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fathom::runtime::flip_test {
namespace {

constexpr int kWidth = 40, kHeight = 30;

using Pixels = std::vector<float>;

Pixels draw(const std::function<float(int x, int y, int channel)>& value) {
  Pixels rgb;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) rgb.push_back(value(x, y, c));
    }
  }
  return rgb;
}
Pixels plain(float r, float g, float b) {
  return draw([&](int, int, int c) { return c == 0 ? r : c == 1 ? g : b; });
}
Flip flip_of(const Pixels& a, const Pixels& b, float pixels_per_degree = kPixelsPerDegree) {
  return flip({kWidth, kHeight, a}, {kWidth, kHeight, b}, pixels_per_degree);
}
float checker(int x, int y, int) { return (x / 4 + y / 4) % 2 == 0 ? 0.8f : 0.2f; }

// The paper's formulas in double for images of one grey, which have no hue and no features.
double grey_flip(double a, double b) {
  const auto lightness = [](double t) {
    return 116 * (t > 216.0 / 24389 ? std::cbrt(t) : t * 841 / 108 + 4.0 / 29) - 16;
  };
  // L*a*b* of sRGB's green and blue: (87.735, -86.183, 83.179), (32.297, 79.188, -107.860). The Hunt adjustment
  // scales a and b by L/100.
  const double max_a = 0.87735 * -86.183 - 0.32297 * 79.188, max_b = 0.87735 * 83.179 + 0.32297 * 107.860;
  const double most = std::pow(87.735 - 32.297 + std::hypot(max_a, max_b), 0.7);
  const double error = std::pow(std::abs(lightness(a) - lightness(b)), 0.7);
  if (error < 0.4 * most) return 0.95 / (0.4 * most) * error;
  return 0.95 + (error - 0.4 * most) / (0.6 * most) * 0.05;
}

TEST_CASE("flip: 0 for one picture and the same", "[image]") {
  const Flip same = flip_of(draw(checker), draw(checker));
  CHECK(same.mean == 0);
  CHECK(*std::max_element(same.map.begin(), same.map.end()) == 0);
}

TEST_CASE("flip: plain greys differ as the formulas say", "[image]") {
  CHECK(flip_of(plain(0, 0, 0), plain(1, 1, 1)).mean == Approx(0.9674).margin(1e-4));
  for (const float grey : {0.001f, 0.02f, 0.3f, 0.55f}) {
    CAPTURE(grey);
    const double truth = grey_flip(static_cast<double>(grey), 0.5);
    CHECK(flip_of(plain(grey, grey, grey), plain(0.5f, 0.5f, 0.5f)).mean == Approx(truth).margin(5e-4));
  }
  CHECK(flip_of(plain(0, 1, 0), plain(0, 0, 1)).mean == Approx(1).margin(1e-5));
}

TEST_CASE("flip: both orders are the same, and what a screen cannot show does not count", "[image]") {
  const Pixels a = draw(checker), b = draw([](int x, int, int c) { return static_cast<float>(x + 5 * c) / 50; });
  CHECK(flip_of(a, b).map == flip_of(b, a).map);
  const Pixels bright = draw([](int x, int y, int c) { return x < 20 ? 5 : checker(x, y, c); });
  const Pixels white = draw([](int x, int y, int c) { return x < 20 ? 1 : checker(x, y, c); });
  CHECK(flip_of(bright, white).mean == 0);
  const Pixels hole = draw([](int x, int y, int c) { return x == 9 ? NAN : checker(x, y, c); });
  const Pixels black = draw([](int x, int y, int c) { return x == 9 ? 0 : checker(x, y, c); });
  CHECK(flip_of(hole, black).mean == 0);
}

TEST_CASE("flip: more distortion, more difference", "[image]") {
  const Pixels clean = draw(checker);
  double before = 0;
  for (const float strength : {0.01f, 0.03f, 0.1f, 0.19f}) {
    const Pixels noisy = draw([&](int x, int y, int c) {
      return checker(x, y, c) + ((x * 7 + y * 13 + c * 5) % 11 < 6 ? strength : -strength);
    });
    const Flip result = flip_of(noisy, clean);
    CAPTURE(strength);
    CHECK(result.mean > before);
    for (const float value : result.map) REQUIRE((value >= 0 && value <= 1));
    before = result.mean;
  }
}

TEST_CASE("flip: a difference shows where it is, an edge counts more than a faint change", "[image]") {
  const Pixels grey = plain(0.5f, 0.5f, 0.5f);
  const Pixels dot = draw([](int x, int y, int) { return x == 20 && y == 15 ? 1 : 0.5f; });
  const Flip result = flip_of(dot, grey);
  const auto worst = std::max_element(result.map.begin(), result.map.end()) - result.map.begin();
  CHECK(worst % kWidth == 20);
  CHECK(worst / kWidth == 15);
  CHECK(result.map.front() == 0);
  // From further away the same dot is fainter and spread over more pixels.
  const Flip far = flip_of(dot, grey, 200);
  CHECK(*std::max_element(far.map.begin(), far.map.end()) < 0.8f * *(result.map.begin() + worst));
  // A step in brightness differs more at the step than its change alone would.
  const Pixels step = draw([](int x, int, int) { return x < 20 ? 0.5f : 0.55f; });
  const Flip edge = flip_of(step, grey);
  const float plain_part = edge.map[15 * kWidth + 39];
  CHECK(edge.map[15 * kWidth + 20] > 1.2f * plain_part);
}

}  // namespace
}  // namespace fathom::runtime::flip_test
