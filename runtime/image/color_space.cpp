#include "runtime/image/color_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace fathom::runtime {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

dvec3 with_z(dvec2 xy) { return {xy.x, xy.y, 1 - xy.x - xy.y}; }

double largest(const dmat3& matrix) {
  double most = 0;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      const double size = std::abs(matrix[column][row]);
      most = size <= most ? most : size;  // NaN is largest of all
    }
  }
  return most;
}

// Returns the matrix to XYZ that gives white the Y of 1.
std::optional<dmat3> to_xyz(const Chromaticities& from) {
  const dmat3 primaries(with_z(from.red), with_z(from.green), with_z(from.blue));
  // Beyond these bounds a number of a file would take all digits of the others.
  constexpr double kMost = 100, kLeast = 1e-6;
  if (!(largest(primaries) < kMost) || !(std::abs(glm::determinant(primaries)) > kLeast)) return std::nullopt;
  if (!(std::abs(from.white.x) < kMost) || !(from.white.y > kLeast) || !(from.white.y < kMost)) return std::nullopt;
  const dvec3 weights = glm::inverse(primaries) * (with_z(from.white) / from.white.y);
  return dmat3(primaries[0] * weights[0], primaries[1] * weights[1], primaries[2] * weights[2]);
}

bool is_near(dvec2 a, dvec2 b) { return std::abs(a.x - b.x) < 1e-3 && std::abs(a.y - b.y) < 1e-3; }

bool is_xyz(const Chromaticities& from) {
  return is_near(from.red, kCieXyz.red) && is_near(from.green, kCieXyz.green) && is_near(from.blue, kCieXyz.blue);
}

// Returns the matrix of XYZ that makes one white the other. Both have a Y of 1.
dmat3 adaptation(dvec2 from, dvec2 to) {
  const dmat3 cones =
      glm::transpose(dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const dvec3 ratio = (cones * (with_z(to) / to.y)) / (cones * (with_z(from) / from.y));
  return glm::inverse(cones) * dmat3(ratio.x, 0, 0, 0, ratio.y, 0, 0, 0, ratio.z) * cones;
}

}  // namespace

std::optional<dvec3> luminance_weights(const Chromaticities& from) {
  const std::optional<dmat3> xyz = to_xyz(from);
  if (!xyz) return std::nullopt;
  return dvec3((*xyz)[0].y, (*xyz)[1].y, (*xyz)[2].y);
}

std::optional<dmat3> to_srgb(const Chromaticities& from) {
  const Chromaticities srgb;
  const std::optional<dmat3> xyz = to_xyz(from);
  if (!xyz) return std::nullopt;
  const dmat3 adapted =
      is_xyz(from) || is_near(from.white, srgb.white) ? dmat3(1) : adaptation(from.white, srgb.white);
  const dmat3 matrix = glm::inverse(*to_xyz(srgb)) * adapted * *xyz;
  constexpr double kMost = 1e6;  // a matrix with larger numbers only magnifies rounding
  if (!(largest(matrix) < kMost)) return std::nullopt;
  return matrix;
}

void convert_colors(const dmat3& matrix, std::span<float> red, std::span<float> green, std::span<float> blue) {
  if (largest(matrix - dmat3(1)) < 1e-4) return;
  for (std::size_t i = 0; i < red.size(); ++i) {
    const dvec3 color = matrix * dvec3(red[i], green[i], blue[i]);
    if (!std::isfinite(color.x + color.y + color.z)) continue;
    red[i] = static_cast<float>(color.x);
    green[i] = static_cast<float>(color.y);
    blue[i] = static_cast<float>(color.z);
  }
}

std::string to_text(const Chromaticities& chromaticities) {
  const auto& [red, green, blue, white] = chromaticities;
  return fmt::format("red {:g}, {:g}, green {:g}, {:g}, blue {:g}, {:g}, white {:g}, {:g}", red.x, red.y, green.x,
                     green.y, blue.x, blue.y, white.x, white.y);
}

}  // namespace fathom::runtime
