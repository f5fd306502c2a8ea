// The film: for each pixel, sums over its camera paths.
//
// Sums are integer multiples of 2^-32 in 64 bits. Sums of squares are multiples of 2^-64 in 128 bits, which hold the
// squares of the terms exactly. Integer addition does not depend on its order, and a pixel's ids are the ids of its
// sample with the lowest number, so every partition of the work gives the same bits. A sum may reach 2^31, a sum of
// squares 2^64. The film clamps larger sums, which add() and merge() report. A clamped sum depends on the order of
// its terms: terms of the other sign count in full or not, depending on whether they come after the clamping or
// before it.
//
// A film may have a second stage, for samples that only decide numbers of samples (runtime/film/adaptive.h): no mean
// uses them. merge() adds films of parts of the work up to the film of the whole. film_bytes.cpp converts sums to
// bytes and back.
//
// Tested by: tests/runtime/film/film_test.cpp
#pragma once

#include <compare>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "runtime/base/pixel_rect.h"

namespace fathom::vm {
class ByteReader;
class ByteWriter;
}  // namespace fathom::vm

namespace fathom::runtime {

// Max magnitude of the sum over a pixel's samples.
inline constexpr double kMaxPixelSum = 0x1p31;
// A sample below kFaintLight may be off by more than a hundredth, and is 0 below half of kFilmStep.
inline constexpr double kFilmStep = 0x1p-32, kFaintLight = 50 * kFilmStep;

inline constexpr std::uint32_t kNoId = ~0u;

// Contribution of one camera path to its pixel.
struct PathSample {
  glm::vec3 radiance{0};     // linear sRGB
  std::uint32_t number = 0;  // index among the pixel's samples
  // First hit of the path. The members from `albedo` to `material` are unused when `hit` is false.
  bool hit = false;
  glm::vec3 albedo{0};
  glm::vec3 normal{0};                      // unit length, towards the camera
  double depth = 0;                         // along the ray, scene units
  glm::dvec3 position{0};                   // scene units
  std::uint32_t surface = 0, material = 0;  // indices into the scene's tables, or kNoId
  // Number of evaluations of the field by all rays of the path.
  std::uint64_t evaluations = 0;
  std::uint64_t instructions = 0;  // in all these evaluations
};

// The layers of a film in addition to radiance (32 bytes per pixel). A second stage takes the bytes of radiance and
// variance again.
struct FilmLayers {
  bool first_hit = true;  // albedo, normal, depth: 56 bytes per pixel
  bool cost = false;      // evaluations, instructions: 16
  bool position = false;  // of the first hit: 24
  bool ids = false;       // of the first hit's surface and material: 12
  bool variance = false;  // of radiance, as if samples were independent: 48
  bool halves = false;    // radiance of the samples with odd numbers, for the denoiser: 32

  bool operator==(const FilmLayers&) const = default;
};
inline constexpr FilmLayers kAllLayers{true, true, true, true, true};

// Means over a pixel's samples, 0 for layers that the film does not keep.
struct PixelMeans {
  glm::dvec3 radiance{0};
  glm::dvec3 noisy{0};  // radiance before it was denoised; otherwise the same
  // Radiance of the samples with even and with odd numbers.
  glm::dvec3 halves[2] = {glm::dvec3(0), glm::dvec3(0)};
  // Variance of the mean `noisy`, as if the samples were independent: the variance of the samples over their number;
  // 0 for fewer than two samples. The samplers sobol and blue spread samples evenly, so the mean's true variance is
  // less.
  glm::dvec3 variance{0};
  glm::dvec3 albedo{0};    // 0 when no sample hit
  glm::dvec3 normal{0};    // not normalised; 0 when no sample hit
  double depth = 0;        // over the samples that hit; 0 when no sample hit
  glm::dvec3 position{0};  // like `depth`
  // Surface and material, counted from 1, of the sample with the lowest number among the samples that hit; 0 when no
  // sample hit.
  std::uint32_t surface_id = 0, material_id = 0;
  double evaluations = 0;
  double instructions = 0;
  std::uint32_t hits = 0, samples = 0;
};

// Mean radiance over all samples of a pixel, those of the second stage included.
struct RadianceMeans {
  glm::dvec3 radiance{0}, variance{0};  // like the members of PixelMeans
  std::uint32_t samples = 0;
};

__extension__ typedef unsigned __int128 WideSum;  // ISO C++ has no 128-bit integers

class Film {
 public:
  Film() = default;
  // Makes an empty film of a whole image of that size, or of the part `area` of an image.
  Film(int width, int height, FilmLayers layers = {}) : Film(PixelRect{0, 0, width, height}, layers) {}
  explicit Film(PixelRect area, FilmLayers layers = {});

  PixelRect area() const { return area_; }
  int width() const { return area_.width(); }
  int height() const { return area_.height(); }
  FilmLayers layers() const { return layers_; }

  // Adds the second stage to an empty film.
  void add_stage();
  std::size_t stages() const { return stages_.size(); }

  // Makes the film empty, with one stage and a new area.
  void restart(PixelRect area);

  // Adds a sample to a film of one stage. (x, y) is a pixel of the whole image, within area(). Two threads must not
  // add to one pixel at once. Returns false if a sum was clamped.
  bool add(int x, int y, const PathSample& sample);
  // Adds `part`, a film of one stage with the same layers and within area(), to stage 0 or 1. To stage 1, which
  // means() does not use, adds only radiance, its squares and the numbers of samples. Returns false if a sum was
  // clamped.
  bool merge(const Film& part, std::size_t stage = 0);

  PixelMeans means(int x, int y) const;
  std::uint32_t samples(int x, int y) const;  // same as means(x, y).samples
  std::uint64_t samples() const;              // sum over all pixels
  RadianceMeans all_radiance(int x, int y) const;

  // Write and read the sums of the pixels in a rectangle within area(), for film files. read_sums() returns false if
  // the bytes end too early.
  void write_sums(PixelRect rect, vm::ByteWriter& out) const;
  bool read_sums(PixelRect rect, vm::ByteReader& in);
  // Return the number of bytes per pixel in a film file and in memory.
  static std::size_t file_bytes_per_pixel(FilmLayers layers, std::size_t stages);
  static std::size_t memory_per_pixel(FilmLayers layers, std::size_t stages);

  // Makes means() return this radiance, [y][x][rgb] over area(). No sum changes.
  void set_denoised(std::vector<float> radiance);
  bool denoised() const { return !denoised_.empty(); }

  // Returns a hash of all sums except the cost: equal for equal images. FNV-1a (Fowler, Noll, Vo, 1991) over 64-bit
  // words.
  std::uint64_t hash() const;

 private:
  // Sums in units of 2^-32.
  struct Pixel {
    std::int64_t radiance[3] = {};
    std::uint32_t hits = 0, samples = 0;
  };
  struct FirstHit {
    std::int64_t albedo[3] = {}, normal[3] = {};
    std::int64_t depth = 0;
  };
  // Sums over the samples with odd numbers. The rest of the pixel's sums belongs to even numbers.
  struct OddHalf {
    std::int64_t radiance[3] = {};
    std::uint32_t samples = 0;
  };
  struct Position {
    std::int64_t sums[3] = {};
  };
  // Sums of squares in units of 2^-64.
  struct Squares {
    WideSum sums[3] = {};
  };
  // Radiance of one stage, [y][x]. A layer that the film does not keep is empty. The second stage has no odd halves.
  struct Stage {
    std::vector<Pixel> pixels;
    std::vector<Squares> squares;
    std::vector<OddHalf> odd_halves;
  };
  // Surface and material of the sample `number`; all bits are set when no sample hit.
  struct Ids {
    std::uint32_t number = ~0u, surface = kNoId, material = kNoId;
    auto operator<=>(const Ids&) const = default;
  };
  // Unscaled sums: a pixel would take a lifetime to overflow 64 bits of instructions.
  struct Cost {
    std::uint64_t evaluations = 0, instructions = 0;
  };

  template <class Self, class Sink>
  static void visit_pixel(Self& film, std::size_t at, Sink&& sink);
  bool add_squares(Squares& squares, glm::vec3 radiance);
  bool add_first_hit(std::size_t at, const PathSample& sample);
  // Merge `count` pixels of a row, from index `from` of `part` to index `to` of this film.
  bool merge_stage(const Film& part, Stage& stage, std::size_t from, std::size_t to, std::size_t count);
  bool merge_rest(const Film& part, std::size_t from, std::size_t to, std::size_t count);
  RadianceMeans means_of(const Pixel& pixel, const Squares& squares) const;
  void read_radiance(std::size_t at, PixelMeans& means) const;
  void read_first_hit(std::size_t at, PixelMeans& means) const;

  PixelRect area_;
  FilmLayers layers_;
  std::vector<Stage> stages_;  // 1 or 2 stages
  // [y][x], sums over stage 0. A layer that the film does not keep is empty.
  std::vector<FirstHit> first_hits_;
  std::vector<Position> positions_;
  std::vector<Ids> ids_;
  std::vector<Cost> costs_;
  std::vector<float> denoised_;  // [y][x][rgb]; empty until set_denoised()
};

}  // namespace fathom::runtime
