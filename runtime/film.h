// The film: what the paths brought home, summed for each pixel.
//
// Sums are whole multiples of 2^-32 in 64 bits. Integer addition does not depend on its order, so any partition of
// the work gives the same bits. A sum may reach 2^31; beyond that it stays there and is counted. Tested by:
// tests/runtime/film_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fathom::runtime {

// What one camera path adds to its pixel.
struct PathSample {
  glm::vec3 radiance{0};  // linear sRGB
  // Of the first surface met; unused when there was none.
  bool hit = false;
  glm::vec3 albedo{0};
  glm::vec3 normal{0};  // unit length, towards the camera
  double depth = 0;     // along the ray, scene units
};

// Means over a pixel's samples.
struct PixelMeans {
  glm::dvec3 radiance{0};
  glm::dvec3 albedo{0};  // 0 where nothing was hit
  glm::dvec3 normal{0};  // not normalised; 0 where nothing was hit
  double depth = 0;      // over the samples that hit; 0 when none did
  std::uint32_t hits = 0, samples = 0;
};

class Film {
 public:
  Film() = default;
  Film(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // Not to be called for one pixel by two threads at once. False when some sum is full.
  bool add(int x, int y, const PathSample& sample);
  PixelMeans means(int x, int y) const;

  // A hash of every sum: equal for equal pictures. FNV-1a (Fowler, Noll, Vo, 1991) over 64-bit words.
  std::uint64_t hash() const;

 private:
  enum Channel { Red, Green, Blue, AlbedoR, AlbedoG, AlbedoB, NormalX, NormalY, NormalZ, Depth, kChannels };
  struct Pixel {
    std::int64_t sums[kChannels] = {};  // in 2^-32
    std::uint32_t hits = 0, samples = 0;
  };

  int width_ = 0, height_ = 0;
  std::vector<Pixel> pixels_;  // [y][x]
};

}  // namespace fathom::runtime
