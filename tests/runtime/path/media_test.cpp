// Light through glass that touches, contains or lies inside another body.
#include <cmath>

#include "runtime/render.h"
#include "tests/runtime/estimate.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"

namespace fathom::runtime::media_test {
namespace {

// Returns the radiance seen straight down through overlapping slabs, before a uniform light.
glm::dvec3 seen_through(const std::string& materials, const std::string& objects) {
  RenderOptions options;
  options.width = options.height = 16;
  options.spp = 256;
  const auto scene = scene_of(R"("camera": {"type": "orthographic", "position": [0, 3, 0], "target": [0, 0, 0],
      "up": [0, 0, 1], "width": 0.1}, "background": {"bottom": [2, 2, 2], "top": [0, 0, 0]}, "render": {"rr_depth": 40},
      "materials": {)" + materials +
                              R"(}, "objects": [)" + objects + "]");
  const RenderResult result = render(scene, options);
  CHECK(result.stats.march.invalid == 0);
  glm::dvec3 sum(0);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) sum += result.film.means(x, y).radiance;
  }
  return sum / 256.0;
}

std::string layer(double top, double bottom, const char* material) {
  return R"({"type": "box", "half_size": [1, )" + std::to_string((top - bottom) / 2) + R"(, 1], "translate": [0, )" +
         std::to_string((top + bottom) / 2) + R"(, 0], "material": ")" + material + "\"}";
}

TEST_CASE("media: absorption says where one medium ends and another begins", "[path][render][released]") {
  // Without refraction: 0.4 of red glass and 0.6 of blue, which overlap.
  const std::string materials = R"("red": {"type": "transparent", "ior": 1, "absorption": [0, 1, 1], "priority": 1},
      "blue": {"type": "transparent", "ior": 1, "absorption": [2, 1, 0]})";
  const glm::dvec3 seen = seen_through(materials, layer(0.5, 0.1, "red") + "," + layer(0.3, -0.5, "blue"));
  CHECK(seen.x == Approx(2 * std::exp(-2 * 0.6)).epsilon(1e-4));
  CHECK(seen.y == Approx(2 * std::exp(-1 * 0.4 - 1 * 0.6)).epsilon(1e-4));
  CHECK(seen.z == Approx(2 * std::exp(-1 * 0.4)).epsilon(1e-4));
  // With equal priority, the first object in the file fills the overlap.
  const std::string equal = R"("red": {"type": "transparent", "ior": 1, "absorption": [0, 1, 1]},
      "blue": {"type": "transparent", "ior": 1, "absorption": [2, 1, 0]})";
  CHECK(seen_through(equal, layer(0.3, -0.5, "blue") + "," + layer(0.5, 0.1, "red")).x ==
        Approx(2 * std::exp(-2 * 0.6)).epsilon(1e-4));
}

TEST_CASE("media: where water meets glass the step of the index is that between the two",
          "[path][render][released]") {
  // Air, glass 1.5, water 1.5 as another material, air: the middle surface reflects nothing, so it is one slab.
  const std::string same = R"("glass": {"type": "transparent"}, "water": {"type": "transparent"})";
  const std::string layers = layer(0.5, -0.1, "glass") + "," + layer(0, -0.5, "water");
  CHECK(seen_through(same, layers).x == Approx(2 * 0.96 / 1.04).epsilon(1e-2));
  // Three surfaces of reflectance r transmit (1 + sum of r / (1 - r))^-1 without interference.
  const auto r = [](double a, double b) { return (a - b) * (a - b) / ((a + b) * (a + b)); };
  const std::string two =
      R"("glass": {"type": "transparent", "ior": 1.8}, "water": {"type": "transparent", "ior": 1.33})";
  double resistance = 1;
  for (const double one : {r(1, 1.8), r(1.8, 1.33), r(1.33, 1)}) resistance += one / (1 - one);
  CHECK(seen_through(two, layers).x == Approx(2 / resistance).epsilon(1e-2));
}

TEST_CASE("media: what lies within glass is seen through it", "[path][render]") {
  const std::string materials = R"("glass": {"type": "transparent", "ior": 1, "absorption": [1, 1, 1]},
      "lamp": {"type": "emissive", "emission": [1, 1, 1]})";
  const glm::dvec3 seen = seen_through(materials, layer(0.5, -0.5, "glass") + "," + layer(0, -0.3, "lamp"));
  CHECK(seen.x == Approx(std::exp(-0.5)).epsilon(1e-4));
}

std::string ball_round(const std::string& camera) {
  return R"("camera": {)" + camera + R"(}, "background": [1, 1, 1],
      "materials": {"clear": {"type": "transparent", "ior": 1, "absorption": [1, 0, 0]}},
      "objects": [{"type": "sphere", "radius": 1, "material": "clear"}])";
}

double red_of(const std::string& json) {
  RenderOptions options;
  options.width = options.height = 16;
  options.spp = 64;
  return estimate(render(scene_of(json), options).film).mean;
}

// Regression: all rays began in the medium at the camera's own position. For a ball cut by the camera's image plane,
// all rays that missed the ball were black.
TEST_CASE("media: every camera ray begins in what fills its own place", "[path][render]") {
  const std::string plane = R"("type": "orthographic", "position": [0.5, 0, 0], "target": [0.5, 0, -1], "width": )";
  // The path length is half a chord.
  CHECK(red_of(ball_round(plane + "0.002")) == Approx(std::exp(-std::sqrt(0.75))).epsilon(1e-3));
  // A disc of half chords s: its mean of exp(-s) is 2 (1 - 2 / e). The disc covers pi of the 16 square units in view.
  const std::string wide = R"("type": "orthographic", "position": [0, 0, 0], "target": [0, 0, -1], "width": 4)";
  const double share = M_PI / 16;
  CHECK(red_of(ball_round(wide)) == Approx(1 - share + share * 2 * (1 - 2 / M_E)).epsilon(2e-3));
  // A lens half inside the ball: rays that begin outside miss the ball.
  const std::string lens =
      R"("position": [1, 0, 0], "target": [1, 0, -100], "fov": 0.01, "lens_radius": 0.001, "focus_distance": 100)";
  CHECK(red_of(ball_round(lens)) < 1);
  CHECK(red_of(ball_round(lens)) > 0.95);
}

// Regression: light that left the glass on a table continued inside the table, because a union has no surface there.
TEST_CASE("media: glass that stands in a table shows the table", "[path][render]") {
  const std::string materials = R"("glass": {"type": "transparent", "ior": 1},
      "table": {"type": "emissive", "emission": [1, 0.5, 0]})";
  const glm::dvec3 seen = seen_through(materials, layer(0.5, -0.2, "glass") + "," + layer(0, -1, "table"));
  CHECK(seen.x == Approx(1).epsilon(1e-4));
  CHECK(seen.y == Approx(0.5).epsilon(1e-4));
}

}  // namespace
}  // namespace fathom::runtime::media_test
