// The image of a scene's environment with the tables by which it is sampled. The pictures of a sequence and the
// moments of a shutter share one map. Tested by: tests/runtime/light/environment_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "runtime/light/environment_file.h"
#include "runtime/sampling/piecewise_constant_sphere.h"
#include "vm/encoding/digest.h"

namespace fathom::runtime {

// Light from all around, sampled by what its luminance exceeds the mean by.
struct UnevenLight {
  // `height` rows of `width` cells: their luminances, and perhaps the pixels of an image.
  UnevenLight(int width, int height, std::vector<float> luminances, std::span<const glm::vec3> pixels = {});

  double mean_of_all;  // luminance
  PiecewiseConstantSphere sphere;
  float even;  // irradiance by the rest, which is not sampled, as luminance
};

struct EnvironmentMap {
  explicit EnvironmentMap(const EnvironmentImage& image);

  int width, height;
  vm::Digest digest;  // of the pixels
  UnevenLight light;
  std::string warning;  // as of EnvironmentImage
};

// Reads the map of a scene's background. Messages say that they are about it.
std::variant<std::shared_ptr<const EnvironmentMap>, ImageReadError> read_background(const std::string& path,
                                                                                    const ReadLimits& limits);

}  // namespace fathom::runtime
