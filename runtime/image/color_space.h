// Colours given by other primaries than those of linear sRGB.
// Tested by: tests/runtime/image/color_space_test.cpp
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>

namespace fathom::runtime {

// CIE xy of the primaries and of the white. The default is ITU-R BT.709, as in sRGB.
struct Chromaticities {
  glm::dvec2 red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06}, white{0.3127, 0.3290};
};

// The numbers are CIE XYZ. They are converted as they are: the white of these primaries, (1/3, 1/3), only says that a
// primary has its weight of 1, not which light is neutral.
inline constexpr Chromaticities kCieXyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};

// Returns the weights of red, green and blue in Y, or nullopt when the primaries span no triangle or the white
// has no luminance.
std::optional<glm::dvec3> luminance_weights(const Chromaticities& from);

// Returns the matrix that converts to linear sRGB: nullopt as above. Neutral colours stay neutral, because whites
// are adapted by the Bradford matrix. Source: K. M. Lam, "Metamerism and Colour Constancy", 1985, as in ICC.1:2022,
// annex E.
std::optional<glm::dmat3> to_srgb(const Chromaticities& from);

// Converts pixels, except those that are not finite. Leaves all as they are if the matrix is the unit up to 1e-4.
void convert_colors(const glm::dmat3& matrix, std::span<float> red, std::span<float> green, std::span<float> blue);

std::string to_text(const Chromaticities& chromaticities);

}  // namespace fathom::runtime
