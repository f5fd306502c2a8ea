// Images of a scene's environment: Radiance .hdr and OpenEXR .exr, in linear sRGB.
// Tested by: tests/runtime/light/environment_file_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <variant>
#include <vector>

#include "runtime/image/image_read.h"

namespace fathom::runtime {

struct EnvironmentImage {
  int width = 0, height = 0;
  std::vector<glm::vec3> pixels;  // from the top row; finite and not negative
  std::string warning = {};       // names pixels of the file that are no light; empty when there are none
};

// Returns the image, or the reason why it cannot be read. NaN and negative values become 0, infinity 65504, the
// largest half, and other values at most 1e20.
std::variant<EnvironmentImage, ImageReadError> read_environment(const std::string& path,
                                                                const ReadLimits& limits = {});

}  // namespace fathom::runtime
