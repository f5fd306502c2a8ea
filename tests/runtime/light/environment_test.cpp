// The environment: radiance, and sampled directions against their density.
#include "runtime/light/environment.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/base/color.h"
#include "runtime/sampling/sampler.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/chi_square.h"
#include "tests/support/environments.h"
#include "tests/support/sample_bins.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::environment_test {
namespace {

using test::kPicture, test::kSky, test::look, test::pdf_of, test::random_map, test::sample_of;

const LightSampleContext kUp{{0, 0, 0}, {0, 1, 0}};
const LightSampleContext kAside{{0, 0, 0}, {0.6f, -0.48f, 0.64f}};
const LightSampleContext kBoth{{0, 0, 0}, {0, 0, 1}, true};

compiler::CompiledScene scene_with(const std::string& settings) {
  return scene_of(settings + R"(, "objects": [{"type": "sphere", "radius": 1}])");
}

// Returns a direction by height and turn. Equal steps of both are equal solid angles.
glm::vec3 direction_at(double y, double turn) {
  const double s = std::sqrt(std::max(0.0, 1 - y * y));
  return {s * std::cos(2 * M_PI * turn), y, s * std::sin(2 * M_PI * turn)};
}

// Checks that sampled directions follow pdf() and that pdf() integrates to 1. Discs are left out of both.
void check_density(const Environment& environment, const LightSampleContext& query) {
  constexpr int kRows = 16, kColumns = 16, kGrid = 24;
  std::vector<double> expected(kRows * kColumns), counts(kRows * kColumns);
  double mass = 0;
  for (int r = 0; r < kRows * kGrid; ++r) {
    for (int c = 0; c < kColumns * kGrid; ++c) {
      const glm::vec3 w = direction_at(1 - 2 * (r + 0.5) / (kRows * kGrid), (c + 0.5) / (kColumns * kGrid));
      const double p =
          static_cast<double>(pdf_of(environment, query, w)) * 4 * M_PI / (kRows * kColumns * kGrid * kGrid);
      expected[static_cast<std::size_t>(r / kGrid * kColumns + c / kGrid)] += p;
      mass += p;
    }
  }
  CHECK(mass == Approx(1).epsilon(0.01));
  const int n = test::scaled_cases(40000);
  for (int i = 0; i < n; ++i) {
    Sampler sampler(5, static_cast<std::uint32_t>(i), 0, 0);
    const float choice = sampler.next();
    const glm::vec3 w = sample_of(environment, query, choice, sampler.next2()).direction;
    const double turn = std::atan2(w.z, w.x) / (2 * M_PI);
    const int r = std::clamp(static_cast<int>((1 - static_cast<double>(w.y)) / 2 * kRows), 0, kRows - 1);
    const int c = std::clamp(static_cast<int>((turn < 0 ? turn + 1 : turn) * kColumns), 0, kColumns - 1);
    ++counts[static_cast<std::size_t>(r * kColumns + c)];
  }
  CHECK(std::abs(test::chi_square_deviation(counts, expected, n)) < 5);
}

// Irradiance by samples of the environment, with its standard error. Where a part of the light is left to BSDF
// sampling, samples of the sphere find it (Veach's balance heuristic).
struct Mean {
  double value, error;
};
Mean irradiance(const Environment& environment, const LightSampleContext& query, int n) {
  double sum = 0, squares = 0;
  const double uniform = environment.even_importance() > 0 ? 1 / (4 * M_PI) : 0;
  for (int i = 0; i < n; ++i) {
    Sampler sampler(6, static_cast<std::uint32_t>(i), 0, 0);
    double value = 0;
    const auto add = [&](const test::Seen& seen, float pdf) {
      const auto cosine = static_cast<double>(glm::dot(seen.direction, query.normal));
      const double both = static_cast<double>(pdf) + uniform;
      if (cosine > 0) value += cosine * static_cast<double>(luminance(seen.radiance)) / both;
    };
    if (environment.importance(query) > 0) {
      const float choice = sampler.next();
      const test::Seen sample = sample_of(environment, query, choice, sampler.next2());
      if (sample.pdf > 0) add(sample, sample.pdf);
    }
    const glm::vec2 u = sampler.next2();
    const glm::vec3 w = direction_at(1 - 2 * static_cast<double>(u.x), static_cast<double>(u.y));
    if (uniform > 0) add(look(environment, w), pdf_of(environment, query, w));
    sum += value;
    squares += value * value;
  }
  return {sum / n, std::sqrt((squares / n - sum / n * (sum / n)) / n)};
}

TEST_CASE("environment: directions fall as their density says", "[light]") {
  const Environment sky(scene_with(kSky), nullptr);
  const Environment picture(scene_with(kPicture), random_map(12, 6));
  for (const LightSampleContext& query : {kUp, kAside, kBoth}) {
    check_density(sky, query);
    check_density(picture, query);
  }
}

TEST_CASE("environment: irradiance of gradients and pictures", "[light]") {
  const Environment gradient(scene_with(R"("background": {"bottom": [1, 1, 1], "top": [4, 4, 4]})"), nullptr);
  CHECK(!gradient.emits());  // a gradient has no sampler: only hits find its light
  CHECK(gradient.importance(kUp) == 0);
  const auto white =
      std::make_shared<EnvironmentMap>(EnvironmentImage{16, 8, std::vector<glm::vec3>(128, glm::vec3(1))});
  const Environment picture(scene_with(kPicture), white);
  CHECK(!picture.emits());  // nor has an even picture
  const Mean of_white = irradiance(picture, kAside, 40000);
  CHECK(std::abs(of_white.value - 2 * M_PI) < 4 * of_white.error);
}

TEST_CASE("environment: the light of a single bright pixel, as filtering spreads it", "[light]") {
  for (const glm::ivec2 bright :
       {glm::ivec2(200, 60), glm::ivec2(0, 128), glm::ivec2(300, 1), glm::ivec2(511, 254)}) {
    CAPTURE(bright.x, bright.y);
    constexpr int kWidth = 512, kHeight = 256;
    EnvironmentImage image{kWidth, kHeight, std::vector<glm::vec3>(kWidth * kHeight, glm::vec3(0))};
    image.pixels[static_cast<std::size_t>(bright.y * kWidth + bright.x)] = glm::vec3(1000);
    const glm::vec3 up(from_latlong({(bright.x + 0.5) / kWidth, (bright.y + 0.5) / kHeight}));
    // Bilinear weights are tents, two pixels wide.
    double truth = 0;
    constexpr int kSteps = 40;
    for (int row = -kSteps; row < kSteps; ++row) {
      for (int column = -kSteps; column < kSteps; ++column) {
        const double x = (column + 0.5) / kSteps, y = (row + 0.5) / kSteps;
        const double polar = M_PI * (bright.y + 0.5 + y) / kHeight;
        if (polar < 0 || polar > M_PI) continue;
        const double solid_angle = 2 * M_PI * M_PI / (kWidth * kHeight * kSteps * kSteps) * std::sin(polar);
        const glm::dvec3 w = from_latlong({(bright.x + 0.5 + x) / kWidth, polar / M_PI});
        const double across = 1 - std::abs(x);
        // The outer rows are repeated towards the poles.
        const bool beyond = (bright.y == 0 && y < 0) || (bright.y == kHeight - 1 && y > 0);
        const double down = beyond ? 1 : 1 - std::abs(y);
        truth += 1000 * 2 * across * down * solid_angle * glm::dot(w, glm::dvec3(up));
      }
    }
    const Environment picture(scene_with(R"("background": {"type": "image", "file": ")" FATHOM_SOURCE_DIR
                                         R"(/tests/data/one-pixel.hdr", "strength": 2})"),
                              std::make_shared<EnvironmentMap>(image));
    const Mean e = irradiance(picture, {{0, 0, 0}, glm::normalize(up)}, 40000);
    CAPTURE(e.value, truth, e.error);
    CHECK(std::abs(e.value - truth) < 4 * e.error + 1e-4 * truth);
    // The filter varies within the cells: the mean square of a tent over its mean in each cell is 1.44.
    CHECK(e.error < 1.1 / std::sqrt(40000.0) * truth);
  }
}

TEST_CASE("environment: a picture's middle is at -z, its right towards +x, and it turns counter-clockwise",
          "[light]") {
  EnvironmentImage image{4, 2, std::vector<glm::vec3>(8, glm::vec3(0))};
  for (std::size_t i = 0; i < 8; ++i) image.pixels[i] = glm::vec3(static_cast<float>(i));
  const auto shared = std::make_shared<EnvironmentMap>(image);
  const auto looking = [&](const char* rotate, glm::vec3 w) {
    const std::string settings = R"("background": {"type": "image", "file": ")" FATHOM_SOURCE_DIR
                                 R"(/tests/data/one-pixel.hdr", "rotate": )" +
                                 std::string(rotate) + "}";
    return look(Environment(scene_with(settings), shared), glm::normalize(w)).radiance.x;
  };
  // The pixel centres of the upper row: at 45 degrees of elevation, u = 1/8, 3/8, 5/8, 7/8.
  const float s = std::sqrt(0.5f);
  CHECK(looking("0", {-s, 1, s}) == Approx(0).margin(1e-5));
  CHECK(looking("0", {-s, 1, -s}) == Approx(1));
  CHECK(looking("0", {s, 1, -s}) == Approx(2));
  CHECK(looking("0", {s, -1, s}) == Approx(7));
  CHECK(looking("0", {0, 1, -1}) == Approx(1.5));
  CHECK(looking("90", {-s, 1, -s}) == Approx(2));  // the front right of the map has moved to the left
}

TEST_CASE("environment: discs give the irradiance asked for, and rays see them", "[light]") {
  const Environment lit(scene_with(R"("lights": {"far": {"type": "directional", "direction": [0, -1, 0],
      "irradiance": [2, 2, 2], "angle": 5}})"),
                        nullptr);
  CHECK(lit.emits());
  const Mean e = irradiance(lit, kUp, 20000);
  CHECK(e.value == Approx(2).epsilon(1e-3));
  const float sine = static_cast<float>(std::sin(5 * M_PI / 180));
  CHECK(look(lit, {0, 1, 0}).radiance.x == Approx(2 / (M_PI * static_cast<double>(sine * sine))).epsilon(1e-5));
  CHECK(look(lit, glm::normalize(glm::vec3(0.99f * sine, std::sqrt(1 - sine * sine), 0))).radiance.x > 0);
  CHECK(look(lit, glm::normalize(glm::vec3(1.02f * sine, std::sqrt(1 - sine * sine), 0))).radiance.x == 0);
  CHECK(pdf_of(lit, kUp, {0, 1, 0}) == Approx(1 / (2 * M_PI * (1 - std::cos(5 * M_PI / 180)))).epsilon(1e-4));
  CHECK(pdf_of(lit, kUp, {1, 0, 0}) == 0);
}

// The direction is not axis-aligned, so that the float rounding of directions varies.
std::string disc_of(double degrees) {
  return R"("lights": {"far": {"type": "directional", "direction": [-1, -2, -1], "irradiance": [2, 2, 2], "angle": )" +
         std::to_string(degrees) + "}}";
}

TEST_CASE("environment: a disc however small gives the irradiance asked for", "[light]") {
  for (const double degrees : {20.0, 0.265, 1e-2, 1e-4, 1e-6}) {
    CAPTURE(degrees);
    const Environment lit(scene_with(disc_of(degrees)), nullptr);
    const Mean e = irradiance(lit, {{0, 0, 0}, glm::normalize(glm::vec3(1, 2, 1))}, 20000);
    CHECK(e.value == Approx(2).epsilon(degrees > 1 ? 1e-3 : 1e-5));
  }
}

// Regression: for rays, a disc of 1e-4 degrees was 7 % larger than its radiance assumed.
TEST_CASE("environment: rays that hit a small disc find its irradiance", "[light]") {
  const Environment lit(scene_with(disc_of(1e-4)), nullptr);
  const glm::vec3 middle = glm::normalize(glm::vec3(1, 2, 1));
  const glm::vec3 aside = glm::normalize(glm::cross(middle, glm::vec3(1, 0, 0)));
  float least = 0, most = 1e-3f;  // sines of two angles that bracket the disc's rim
  for (int i = 0; i < 40; ++i) {
    const float between = (least + most) / 2;
    (look(lit, glm::normalize(middle + between * aside)).radiance.x > 0 ? least : most) = between;
  }
  CHECK(M_PI * least * least * look(lit, middle).radiance.x == Approx(2).epsilon(1e-3));
}

TEST_CASE("environment: directions to a disc pass a chi-square test against their density", "[light]") {
  const Environment lit(scene_with(disc_of(10)), nullptr);
  test::ChiSquareSetup setup;
  setup.samples = test::scaled_cases(100000);
  // The pole points at the disc's centre and the rows span 5 degrees: the disc's rim is a cell border.
  setup.pole = glm::normalize(glm::vec3(1, 2, 1));
  setup.rows = 36;
  setup.columns = 72;
  for (const LightSampleContext& query : {kUp, kBoth}) {
    const auto sample = [&](Sampler& s) {
      const float choice = s.next();
      return sample_of(lit, query, choice, s.next2()).direction;
    };
    const auto pdf = [&](glm::vec3 w) { return static_cast<double>(pdf_of(lit, query, w)); };
    const test::ChiSquare result = test::chi_square(sample, pdf, setup);
    CAPTURE(result.describe());
    CHECK(result.p > test::sidak(0.01, 2));
    CHECK(result.integral == Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("environment: a sky with its sun is sampled without bias", "[light]") {
  const compiler::CompiledScene scene =
      scene_with(R"("background": {"type": "sky", "elevation": 40, "turbidity": 3})");
  const Environment environment(scene, nullptr);
  const Sky sky(scene.background.sky);
  double level = static_cast<double>(luminance(sky.sun_irradiance())) * scene.background.sky.sun.y;
  constexpr int kSteps = 300;
  for (int r = 0; r < kSteps; ++r) {
    for (int c = 0; c < kSteps; ++c) {
      const double y = (r + 0.5) / kSteps;
      level += y * static_cast<double>(luminance(sky.radiance(direction_at(y, (c + 0.5) / kSteps)))) * 2 * M_PI /
               (kSteps * kSteps);
    }
  }
  const Mean e = irradiance(environment, kUp, 60000);
  CAPTURE(e.value, level, e.error);
  CHECK(std::abs(e.value - level) < 4 * e.error + 1e-3 * level);
  CHECK(e.error < 0.01 * level);
}

TEST_CASE("environment: many rays and many samples are each as one alone", "[light]") {
  const std::string sun = R"("lights": {"sun": {"type": "directional", "direction": [0, -1, 0.5], "angle": 5}})";
  const std::string gradient = R"("background": {"bottom": [0.1, 0.3, 0.7], "top": [1.5, 0.9, 0.2]})";
  for (const std::string& settings : {gradient, gradient + "," + sun, std::string(kSky), kSky + ("," + sun),
                                      std::string(kPicture), kPicture + ("," + sun)}) {
    CAPTURE(settings);
    const Environment environment(scene_with(settings), random_map(12, 6));
    const std::size_t count = DirectionRows::kCapacity - 1;
    DirectionRows rows;
    for (std::size_t i = 0; i < count; ++i) {
      rows.set_direction(i, direction_at(1 - 2 * static_cast<double>(i) / 62, 0.37 * static_cast<double>(i)));
    }
    environment.look_up(count, rows);
    for (std::size_t i = 0; i < count; ++i) {
      const test::Seen one = look(environment, test::seen(rows, i).direction);
      CHECK(test::seen(rows, i).radiance == one.radiance);
      CHECK(rows.density(i) == one.pdf);
    }
    if (!environment.emits()) continue;
    EnvironmentSamples samples;
    for (std::size_t i = 0; i < count; ++i) {
      Sampler sampler(8, static_cast<std::uint32_t>(i), 0, 0);
      samples.context[i] = i % 2 == 0 ? &kUp : &kBoth;
      samples.choice[i] = sampler.next();
      samples.u[i] = sampler.next();
      samples.v[i] = sampler.next();
    }
    environment.sample(count, samples);
    for (std::size_t i = 0; i < count; ++i) {
      const LightSampleContext& context = *samples.context[i];
      const test::Seen one = sample_of(environment, context, samples.choice[i], {samples.u[i], samples.v[i]});
      const test::Seen sample = test::seen(samples.rows, i);
      CHECK(sample.direction == one.direction);
      CHECK(sample.radiance == one.radiance);
      CHECK(environment.pdf(context, sample.direction, sample.pdf) == one.pdf);
      CHECK(sample.radiance == look(environment, sample.direction).radiance);
    }
  }
}

TEST_CASE("environment: nothing beyond the scene is nothing to sample", "[light]") {
  const Environment dark(scene_with(R"("film": {})"), nullptr);
  CHECK_FALSE(dark.emits());
  CHECK(dark.importance(kUp) == 0);
  CHECK(pdf_of(dark, kUp, {0, 1, 0}) == 0);
}

}  // namespace
}  // namespace fathom::runtime::environment_test
