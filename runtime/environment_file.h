// Pictures of what surrounds a scene: Radiance .hdr and OpenEXR .exr, in linear sRGB.
// Tested by: tests/runtime/environment_file_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <variant>
#include <vector>

namespace fathom::runtime {

struct EnvironmentImage {
  int width = 0, height = 0;
  std::vector<glm::vec3> pixels;  // from the top row; finite and not negative
};

// The picture, or why it cannot be read, for people. What is not a number or negative in it becomes 0, and what is
// beyond float its largest.
std::variant<EnvironmentImage, std::string> read_environment(const std::string& path);

}  // namespace fathom::runtime
