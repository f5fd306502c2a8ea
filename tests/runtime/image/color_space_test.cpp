#include "runtime/image/color_space.h"

#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "tests/support/catch.h"

namespace fathom::runtime::color_space_test {
namespace {

double error_of(const glm::dmat3& matrix, const glm::dmat3& rows) {
  const glm::dmat3 difference = matrix - glm::transpose(rows);
  double most = 0;
  for (int i = 0; i < 9; ++i) most = std::max(most, std::abs(difference[i / 3][i % 3]));
  return most;
}

TEST_CASE("color_space: known matrices", "[image]") {
  CHECK(error_of(*to_srgb({}), glm::dmat3(1)) < 1e-12);
  // Primaries in another order are an exact permutation.
  const Chromaticities srgb;
  CHECK(error_of(*to_srgb({srgb.blue, srgb.red, srgb.green, srgb.white}), glm::dmat3(0, 1, 0, 0, 0, 1, 1, 0, 0)) <
        1e-12);
  // IEC 61966-2-1 rounds the white's XYZ.
  CHECK(error_of(*to_srgb(kCieXyz),
                 glm::dmat3(3.2410, -1.5374, -0.4986, -0.9692, 1.8760, 0.0416, 0.0556, -0.2040, 1.0570)) < 1e-3);
  // ITU-R BT.2087, annex 1 inverted.
  CHECK(error_of(*to_srgb({{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, srgb.white}),
                 glm::dmat3(1.6605, -0.5876, -0.0728, -0.1246, 1.1329, -0.0083, -0.0182, -0.1006, 1.1187)) < 2e-4);
  // ACEScg: Academy S-2014-004, with the Bradford adaptation of D60 to D65.
  CHECK(error_of(*to_srgb({{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}}),
                 glm::dmat3(1.70505, -0.62179, -0.08326, -0.13026, 1.14080, -0.01055, -0.02400, -0.12897, 1.15297)) <
        2e-4);
}

// The means of Chromaticities/Rec709.exr and XYZ.exr of openexr-images, which must look the same, as listed by the
// tests of GafferImage. XYZ is not adapted, though its white is said to be (1/3, 1/3).
TEST_CASE("color_space: the public pair of Rec. 709 and XYZ", "[image]") {
  const glm::dvec3 rec709(0.365261, 0.277788, 0.115344), xyz(0.27078, 0.284661, 0.14981);
  CHECK(glm::distance(*to_srgb(kCieXyz) * xyz, rec709) < 1e-3);
}

TEST_CASE("color_space: neutral stays neutral under any white", "[image]") {
  for (const glm::dvec2 white :
       {glm::dvec2(0.3457, 0.3585), {0.32168, 0.33767}, {1.0 / 3, 1.0 / 3}, {0.44757, 0.40745}}) {
    Chromaticities other;
    other.white = white;
    CHECK(glm::distance(*to_srgb(other) * glm::dvec3(1), glm::dvec3(1)) < 1e-3);
    const glm::dvec3 weights = *luminance_weights(other);
    CHECK(weights.x + weights.y + weights.z == Approx(1));
  }
}

TEST_CASE("color_space: chromaticities without a triangle have no matrix", "[image]") {
  const Chromaticities srgb;
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const Chromaticities& bad : {Chromaticities{{0, 0}, {0, 0}, {0, 0}, {0, 0}},
                                    {srgb.red, srgb.red, srgb.blue, srgb.white},
                                    {srgb.red, srgb.green, srgb.blue, {0.3, 0}},
                                    {{nan, 0}, srgb.green, srgb.blue, srgb.white},
                                    {srgb.red, {0, infinity}, srgb.blue, srgb.white},
                                    {srgb.red, srgb.green, srgb.blue, {nan, 0.3}},
                                    {srgb.red, srgb.green, srgb.blue, {0.3, -0.3}}}) {
    CAPTURE(to_text(bad));
    CHECK_FALSE(to_srgb(bad));
    CHECK_FALSE(luminance_weights(bad));
  }
}

TEST_CASE("color_space: pixels that are not finite stay as they are", "[image]") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> red = {1, kInfinity}, green = {0, 1}, blue = {0, 1};
  convert_colors(*to_srgb(kCieXyz), red, green, blue);
  CHECK(red[0] == Approx(3.2410).margin(1e-3));
  CHECK((red[1] == kInfinity && green[1] == 1 && blue[1] == 1));
}

}  // namespace
}  // namespace fathom::runtime::color_space_test
