#include "runtime/denoise/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "runtime/denoise/nl_means.h"
#include "runtime/image/image_diff.h"
#include "runtime/render.h"
#include "runtime/sampling/sampler.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "vm/encoding/digest.h"

namespace fathom::runtime::denoise_test {
namespace {

using Pixels = std::vector<float>;

// An image with its truth: two noisy copies, and the features of the surface seen in each pixel.
struct Scene {
  int width, height;
  Pixels truth, first, second, albedo, normal, depth;

  DenoiseInput input() const { return {width, height, first, second, albedo, normal, depth}; }
  RgbView view(const Pixels& rgb) const { return {width, height, rgb}; }
  Pixels noisy() const {
    Pixels mean;
    for (std::size_t i = 0; i < first.size(); ++i) mean.push_back((first[i] + second[i]) / 2);
    return mean;
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

struct Surface {
  std::array<float, 3> albedo, normal;
  float depth, light;
};
using Seen = std::function<Surface(int x, int y)>;
// Returns a random factor of mean 1.
using Noise = std::function<float(Sampler& sampler)>;

Scene draw(int width, int height, const Seen& seen, const Noise& noise) {
  Scene scene{width, height, {}, {}, {}, {}, {}, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Surface surface = seen(x, y);
      Sampler sampler(7, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0);
      const float factors[2] = {noise(sampler), noise(sampler)};
      for (std::size_t c = 0; c < 3; ++c) {
        const float truth = surface.albedo[c] * surface.light;
        scene.truth.push_back(truth);
        scene.first.push_back(truth * factors[0]);
        scene.second.push_back(truth * factors[1]);
        scene.albedo.push_back(surface.albedo[c]);
        scene.normal.push_back(surface.normal[c]);
      }
      scene.depth.push_back(surface.depth);
    }
  }
  return scene;
}

// A chequered floor and wall, lit by a lamp at the upper left. The edge of the shadow shows in no feature.
Surface room(int x, int y) {
  const bool wall = x < 48;
  const float dx = static_cast<float>(x - 20) / 60, dy = static_cast<float>(y - 10) / 60;
  const bool shadow = !wall && x + y > 110;
  const bool white = (x / 6 + y / 6) % 2 == 0;
  Surface surface;
  surface.albedo = white ? std::array{0.8f, 0.7f, 0.6f} : std::array{0.1f, 0.3f, 0.2f};
  surface.normal = wall ? std::array{1.0f, 0.0f, 0.0f} : std::array{0.0f, 1.0f, 0.0f};
  surface.depth = wall ? 3 + dx : 3 + dy;
  surface.light = (wall ? 1.0f : 0.6f) / (1 + dx * dx + dy * dy) * (shadow ? 0.2f : 1);
  return surface;
}

// The mean of `count` exponentially distributed numbers: strong, skewed noise like that of few paths.
Noise exponential(int count) {
  return [count](Sampler& sampler) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum -= std::log(1 - static_cast<double>(sampler.next()));
    return static_cast<float>(sum / count);
  };
}
float no_noise(Sampler&) { return 1; }

double relmse(const Scene& scene, const Pixels& picture) {
  return compare(scene.view(picture), scene.view(scene.truth)).relmse;
}

TEST_CASE("denoise: the error falls to a fifth and less, for weak and strong noise", "[denoise][released]") {
  for (const int samples : {1, 4, 16}) {
    CAPTURE(samples);
    const Scene scene = draw(96, 80, room, exponential(samples));
    const Pixels result = denoise(scene.input(), 2);
    const double before = relmse(scene, scene.noisy()), after = relmse(scene, result);
    CAPTURE(before, after);
    CHECK(after <= before / 5);
    // The denoiser neither adds nor loses energy.
    CHECK(compare(scene.view(result), scene.view(scene.truth)).mean == Approx(0).margin(0.01));
  }
}

TEST_CASE("denoise: a picture without noise stays as it is", "[denoise]") {
  const Scene flat = draw(
      40, 30,
      [](int, int) {
        return Surface{{0.5f, 0.5f, 0.5f}, {0, 0, 1}, 2, 3};
      },
      no_noise);
  const Differences plain = compare(flat.view(denoise(flat.input(), 1)), flat.view(flat.truth));
  CHECK(plain.max <= 1e-6);
  const Scene detailed = draw(96, 80, room, no_noise);
  CHECK(compare(detailed.view(denoise(detailed.input(), 1)), detailed.view(detailed.truth)).max <= 1e-5);
}

TEST_CASE("denoise: nothing bleeds over an edge of albedo, normal or depth", "[denoise]") {
  const auto left = [](int x) { return x < 24; };
  const Surface base{{0.5f, 0.5f, 0.5f}, {0, 0, 1}, 2, 1};
  const Seen edges[] = {[&](int x, int) {
                          Surface s = base;
                          if (left(x)) s.albedo = {0.9f, 0.05f, 0.05f};
                          return s;
                        },
                        [&](int x, int) {
                          Surface s = base;
                          if (left(x)) s.normal = {1, 0, 0}, s.light = 8;
                          return s;
                        },
                        [&](int x, int) {
                          Surface s = base;
                          if (left(x)) s.depth = 3, s.light = 8;
                          return s;
                        }};
  for (const Seen& edge : edges) {
    const Scene scene = draw(48, 32, edge, exponential(4));
    const Pixels result = denoise(scene.input(), 1);
    // The columns next to the edge: their mean over the rows against the truth.
    for (const int x : {22, 23, 24, 25}) {
      for (std::size_t c = 0; c < 3; ++c) {
        double mean = 0;
        for (int y = 0; y < 32; ++y) mean += static_cast<double>(result[3 * scene.at(x, y) + c]) / 32;
        CAPTURE(x, c);
        CHECK(mean == Approx(scene.truth[3 * scene.at(x, 0) + c]).epsilon(0.1));
      }
    }
  }
}

TEST_CASE("denoise: what is not finite does not spread and is filled", "[denoise]") {
  Scene scene = draw(64, 48, room, exponential(4));
  const Pixels clean = denoise(scene.input(), 1);
  scene.first[3 * scene.at(20, 20)] = NAN;
  scene.second[3 * scene.at(50, 30) + 1] = INFINITY;
  scene.albedo[3 * scene.at(5, 40) + 2] = NAN;
  scene.normal[3 * scene.at(30, 10)] = INFINITY;
  scene.depth[scene.at(40, 40)] = NAN;
  const Pixels result = denoise(scene.input(), 1);
  for (const float value : result) REQUIRE(std::isfinite(value));
  CHECK(relmse(scene, result) <= 1.1 * relmse(scene, clean));
  const std::size_t lost = 3 * scene.at(20, 20);
  CHECK(result[lost] == Approx(scene.truth[lost]).epsilon(0.3));
}

TEST_CASE("denoise: a firefly goes down and its light stays near", "[denoise]") {
  Scene scene = draw(
      64, 48,
      [](int, int) {
        return Surface{{1, 1, 1}, {0, 0, 1}, 2, 1};
      },
      exponential(16));
  const std::size_t at = 3 * scene.at(32, 24);
  for (std::size_t c = 0; c < 3; ++c) scene.first[at + c] = 1e4f;
  const Pixels result = denoise(scene.input(), 1);
  CHECK(result[at] < 200);
  CHECK(result[3 * scene.at(10, 10)] == Approx(1).epsilon(0.1));
  for (const float value : result) REQUIRE((value >= 0 && std::isfinite(value)));
}

TEST_CASE("denoise: a firefly has no edge where the window ends", "[denoise]") {
  Scene scene = draw(
      64, 64,
      [](int, int) {
        return Surface{{1, 1, 1}, {0, 0, 1}, 2, 1};
      },
      exponential(64));
  for (std::size_t c = 0; c < 3; ++c) scene.first[3 * scene.at(32, 32) + c] = 1e4f;
  const Pixels result = denoise(scene.input(), 1);
  // Returns the mean of the firefly's light over the pixels at these distances from it.
  const auto added = [&](double from, double to) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const double away = std::hypot(x - 32, y - 32);
        if (away < from || away >= to) continue;
        sum += static_cast<double>(result[3 * scene.at(x, y)]) - 1;
        ++count;
      }
    }
    return sum / count;
  };
  const double near = added(0, 4);
  CHECK(near > 5);
  CHECK(added(4, 6) < 0.9 * near);
  CHECK(added(7.5, 8.5) < 0.3 * near);  // at the border of the window
  CHECK(added(9, 12) < 0.02 * near);    // in the corners of the square around the window
}

TEST_CASE("denoise: scales with the light", "[denoise]") {
  const Scene scene = draw(48, 40, room, exponential(2));
  Scene bright = scene;
  for (Pixels* pixels : {&bright.first, &bright.second}) {
    for (float& value : *pixels) value *= 0x1p20f;
  }
  const Pixels result = denoise(scene.input(), 1), scaled = denoise(bright.input(), 1);
  for (std::size_t i = 0; i < result.size(); ++i) REQUIRE(scaled[i] == Approx(result[i] * 0x1p20f).epsilon(1e-3));
}

// A ball on a floor under a ring of light.
TEST_CASE("denoise: a rendered picture has less than half the error", "[denoise][heavy]") {
  const auto scene = scene_of(R"("camera": {"position": [0, 1.5, 4], "target": [0, 0, 0]},
      "materials": {"glow": {"type": "emissive", "emission": [20, 20, 20]}},
      "objects": [{"type": "torus", "major_radius": 0.4, "minor_radius": 0.1, "translate": [0, 2, 0.5], "material": "glow"},
                  {"type": "sphere", "radius": 0.5, "translate": [0, 0.5, 0]},
                  {"type": "box", "half_size": [4, 0.1, 4], "translate": [0, -0.1, 0]}])");
  constexpr int kWidth = 64, kHeight = 48;
  RenderOptions options;
  options.width = kWidth, options.height = kHeight, options.spp = 8;
  options.layers = {.first_hit = true, .halves = true};
  const auto radiance = [&](const Film& film) {
    Pixels pixels;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        for (int c = 0; c < 3; ++c) pixels.push_back(static_cast<float>(film.means(x, y).radiance[c]));
      }
    }
    return pixels;
  };
  Film film = render(scene, options).film;
  const Pixels noisy = radiance(film);
  denoise(film, 2);
  const Pixels denoised = radiance(film);
  options.spp = 512, options.seed = 3;
  const Pixels truth = radiance(render(scene, options).film);
  const auto error = [&](const Pixels& pixels) {
    return compare({kWidth, kHeight, pixels}, {kWidth, kHeight, truth}).relmse;
  };
  CAPTURE(error(noisy), error(denoised));
  CHECK(error(denoised) < error(noisy) / 2);
}

TEST_CASE("denoise: any number of threads gives the same bits", "[denoise]") {
  const Scene scene = draw(150, 70, room, exponential(2));
  const Pixels one = denoise(scene.input(), 1);
  CHECK(denoise(scene.input(), 2) == one);
  CHECK(denoise(scene.input(), 3) == one);
}

// Regression: no test noticed a kernel whose result depended on the number of lanes.
TEST_CASE("denoise: the same bits on every processor", "[denoise][isa]") {
  std::mt19937 random(1);  // the standard defines its numbers
  const auto plane = [&](float low, float high) {
    Plane values(90 * 37);
    for (float& value : values) value = low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
    return values;
  };
  NlMeansInput input{90, 37, {}, {}, plane(2, 2.1f), plane(1, 1)};
  for (auto& copy : input.copies) {
    for (Plane& channel : copy) channel = plane(0.5f, 1);
  }
  for (Plane& feature : input.features) feature = plane(0, 0.1f);
  std::string bytes;
  for (const Plane& channel : nl_means(input, 2, {})) {
    bytes.append(reinterpret_cast<const char*>(channel.data()), channel.size() * sizeof(float));
  }
  CHECK(vm::digest(bytes).text() == "445473383f9701b78945c383a74350c0");
}

TEST_CASE("denoise: pictures of a pixel, a row and a column", "[denoise]") {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(30, 1), std::pair(1, 30)}) {
    const Scene scene = draw(width, height, room, exponential(4));
    for (const float value : denoise(scene.input(), 2)) CHECK(std::isfinite(value));
  }
}

TEST_CASE("denoise: a film keeps all but its radiance, and all of it when cancelled", "[denoise]") {
  Film film(PixelRect{100, 50, 124, 66}, {.halves = true});
  const Noise noise = exponential(1);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 24; ++x) {
      for (std::uint32_t number = 0; number < 5; ++number) {
        Sampler sampler(1, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), number);
        PathSample sample;
        sample.number = number;
        sample.radiance = glm::vec3(2 * noise(sampler));
        if (x < 12) sample.hit = true, sample.albedo = glm::vec3(0.5f), sample.normal = {0, 0, 1}, sample.depth = 3;
        film.add(x + 100, y + 50, sample);
      }
    }
  }
  Film result = film;
  CHECK(!denoise(result, 2, [] { return true; }));
  CHECK(!result.denoised());
  REQUIRE(denoise(result, 2, [] { return false; }));
  REQUIRE(result.denoised());
  double before = 0, after = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 24; ++x) {
      const PixelMeans was = film.means(x + 100, y + 50), is = result.means(x + 100, y + 50);
      CHECK(is.noisy == was.radiance);
      CHECK(is.samples == 5);
      CHECK(is.hits == was.hits);
      CHECK(is.albedo == was.albedo);
      CHECK(is.normal == was.normal);
      CHECK(is.depth == was.depth);
      CHECK(is.halves[1] == was.halves[1]);
      before += (was.radiance.x - 2) * (was.radiance.x - 2);
      after += (is.radiance.x - 2) * (is.radiance.x - 2);
    }
  }
  CHECK(after < before / 5);
}

}  // namespace
}  // namespace fathom::runtime::denoise_test
