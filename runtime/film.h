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
  glm::vec3 radiance{0};     // linear sRGB
  std::uint32_t number = 0;  // among the pixel's samples
  // Of the first surface met; unused when there was none.
  bool hit = false;
  glm::vec3 albedo{0};
  glm::vec3 normal{0};  // unit length, towards the camera
  double depth = 0;     // along the ray, scene units
  // Of the field, for all the path's rays.
  std::uint64_t evaluations = 0;
  std::uint64_t instructions = 0;  // over those evaluations
};

// What a film keeps beside radiance, 56, 16 and 32 bytes a pixel.
struct FilmLayers {
  bool first_hit = true;  // albedo, normal, depth
  bool cost = false;      // evaluations, instructions
  bool halves = false;    // radiance of the samples with even numbers apart from the others: what the denoiser needs
};

// Means over a pixel's samples; 0 for what the film does not keep.
struct PixelMeans {
  glm::dvec3 radiance{0};
  glm::dvec3 halves[2] = {glm::dvec3(0), glm::dvec3(0)};  // radiance of the samples with even and odd numbers
  glm::dvec3 albedo{0};                                   // 0 where nothing was hit
  glm::dvec3 normal{0};                                   // not normalised; 0 where nothing was hit
  double depth = 0;                                       // over the samples that hit; 0 when none did
  double evaluations = 0;
  double instructions = 0;
  std::uint32_t hits = 0, samples = 0;
};

class Film {
 public:
  Film() = default;
  Film(int width, int height, FilmLayers layers = {});

  int width() const { return width_; }
  int height() const { return height_; }
  FilmLayers layers() const { return layers_; }

  // Not to be called for one pixel by two threads at once. False when some sum is full.
  bool add(int x, int y, const PathSample& sample);
  PixelMeans means(int x, int y) const;

  // Puts another mean in the place of the pixel's radiance, its halves stay; does nothing where there are no samples.
  void set_radiance(int x, int y, glm::dvec3 mean);

  // A hash of every sum but the cost's: equal for equal pictures. FNV-1a (Fowler, Noll, Vo, 1991) over 64-bit words.
  std::uint64_t hash() const;

 private:
  // Sums in 2^-32.
  struct Pixel {
    std::int64_t radiance[3] = {};
    std::uint32_t hits = 0, samples = 0;
  };
  struct FirstHit {
    std::int64_t albedo[3] = {}, normal[3] = {};
    std::int64_t depth = 0;
  };
  // The sums over odd numbers; the others are what is left of the pixel's.
  struct OddHalf {
    std::int64_t radiance[3] = {};
    std::uint32_t samples = 0;
  };
  // Plain sums: 64 bits of instructions take a pixel a lifetime.
  struct Cost {
    std::uint64_t evaluations = 0, instructions = 0;
  };

  void read_halves(std::size_t at, PixelMeans& means) const;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  FilmLayers layers_;
  // [y][x]; a layer that is not kept has none.
  std::vector<Pixel> pixels_;
  std::vector<FirstHit> first_hits_;
  std::vector<Cost> costs_;
  std::vector<OddHalf> odd_halves_;
};

}  // namespace fathom::runtime
