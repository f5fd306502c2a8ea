// The film: what the paths brought home, summed for each pixel.
//
// Sums are whole multiples of 2^-32 in 64 bits, those of squares of 2^-64 in 128 bits: the exact squares of the
// terms. Integer addition does not depend on its order, and a pixel's ids are those of its sample with the least
// number, so any partition of the work gives the same bits. A sum may reach 2^31 (of squares 2^63); beyond that it is
// cut off, which add() and merge() tell, and what it is then depends on the order: terms of the other sign come after
// the cut or before it.
//
// A film in stages (runtime/film/adaptive.h) keeps radiance and the number of samples of each stage apart. Stages 0
// and 1 are two halves of the samples, whose means weigh the same. No mean uses stages 2 and 3. Films of any parts of
// the work add up to the film of the whole: merge(). As bytes: film_bytes.cpp.
//
// Tested by: tests/runtime/film/film_test.cpp
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <span>
#include <vector>

#include "runtime/base/pixel_rect.h"

namespace fathom::vm {
class ByteReader;
class ByteWriter;
}  // namespace fathom::vm

namespace fathom::runtime {

// What the samples of a pixel may add up to.
inline constexpr double kFullPixel = 0x1p31;
// Fainter samples may be off by more than a hundredth, and are 0 below half of kFilmStep.
inline constexpr double kFilmStep = 0x1p-32, kFaintLight = 50 * kFilmStep;

inline constexpr std::uint32_t kNoId = ~0u;

// What one camera path adds to its pixel.
struct PathSample {
  glm::vec3 radiance{0};     // linear sRGB
  std::uint32_t number = 0;  // among the pixel's samples
  // Of the first surface met; unused when there was none.
  bool hit = false;
  glm::vec3 albedo{0};
  glm::vec3 normal{0};                      // unit length, towards the camera
  double depth = 0;                         // along the ray, scene units
  glm::dvec3 position{0};                   // scene units
  std::uint32_t surface = 0, material = 0;  // indices into the scene's tables, or kNoId
  // Of the field, for all the path's rays.
  std::uint64_t evaluations = 0;
  std::uint64_t instructions = 0;  // over those evaluations
};

// The layers of a film in addition to radiance (32 bytes per pixel). Each further stage takes the bytes of radiance
// and variance again.
struct FilmLayers {
  bool first_hit = true;  // albedo, normal, depth: 56 bytes a pixel
  bool cost = false;      // evaluations, instructions: 16
  bool position = false;  // of the first surface: 24
  bool ids = false;       // of the first surface: 12
  bool variance = false;  // of radiance, as if samples were independent: 48
  // radiance of two halves of the samples, for the denoiser: 32 in a film of one stage, 0 with stages
  bool halves = false;

  bool operator==(const FilmLayers&) const = default;
};
inline constexpr FilmLayers kAllLayers{true, true, true, true, true};

// Means over a pixel's samples, 0 for layers that the film does not keep. In a film with stages `radiance` and
// `noisy` are the mean of the means of stages 0 and 1. The other values are means over the samples of both stages.
struct PixelMeans {
  glm::dvec3 radiance{0};
  glm::dvec3 noisy{0};  // radiance before it was denoised; otherwise the same
  // of stages 0 and 1; in a film of one stage of the samples with even and odd numbers
  glm::dvec3 halves[2] = {glm::dvec3(0), glm::dvec3(0)};
  // Of `noisy`, the mean, as if the samples were independent: that of the samples by their number; 0 for fewer than
  // two. Of samplers that spread samples evenly, sobol and blue, the mean's own variance is less.
  glm::dvec3 variance{0};
  glm::dvec3 albedo{0};    // 0 where nothing was hit
  glm::dvec3 normal{0};    // not normalised; 0 where nothing was hit
  double depth = 0;        // over the samples that hit; 0 when none did
  glm::dvec3 position{0};  // likewise
  // Of the sample with the least number among those that hit: its surface and material counted from 1; 0 when none
  // did.
  std::uint32_t surface_id = 0, material_id = 0;
  double evaluations = 0;
  double instructions = 0;
  std::uint32_t hits = 0, samples = 0;
};

// The mean radiance of a pixel's samples of some stages, all weighing the same; a half without samples has none.
struct RadianceMeans {
  glm::dvec3 radiance{0}, variance{0}, halves[2] = {glm::dvec3(0), glm::dvec3(0)};  // as PixelMeans has them
  std::uint32_t samples = 0, half_samples[2] = {0, 0};
};

__extension__ typedef unsigned __int128 WideSum;  // C++ has no name of its own for it

class Film {
 public:
  Film() = default;
  // A whole picture of that size, or a part of one.
  Film(int width, int height, FilmLayers layers = {}) : Film(PixelRect{0, 0, width, height}, layers) {}
  explicit Film(PixelRect area, FilmLayers layers = {});

  PixelRect area() const { return area_; }
  int width() const { return area_.width(); }
  int height() const { return area_.height(); }
  FilmLayers layers() const { return layers_; }

  // Turns an empty film into one of 2 or 4 stages. A pixel without samples in one of stages 0 and 1 has the mean of
  // the other.
  void begin_stages(std::size_t count);
  std::size_t stages() const { return stages_.size(); }

  // Empty again, and of another area.
  void restart(PixelRect area);

  // (x, y) is a pixel of the whole picture, within area(). To the last stage. Not to be called for one pixel by two
  // threads at once. False when some sum is full.
  bool add(int x, int y, const PathSample& sample);
  // Everything that `part` has, which is a film of one stage with the same layers and lies within area(), is added to
  // the given stage; its radiance alone, where means() does not look at that. False when some sum is full.
  bool merge(const Film& part, std::size_t stage = 0);

  PixelMeans means(int x, int y) const;
  std::uint32_t samples(int x, int y) const;  // as means() has them
  std::uint64_t samples() const;              // of all pixels
  RadianceMeans radiance_of(std::initializer_list<std::size_t> stages, int x, int y) const;

  // The sums of the pixels in a rectangle within area(), for a file; read_sums() is false when the bytes end before.
  void write_sums(PixelRect rect, vm::ByteWriter& out) const;
  bool read_sums(PixelRect rect, vm::ByteReader& in);
  // How many bytes a pixel takes there, and in memory.
  static std::size_t file_bytes_per_pixel(FilmLayers layers, std::size_t stages);
  static std::size_t memory_per_pixel(FilmLayers layers, std::size_t stages);

  // From now on means().radiance is this, [y][x][rgb] over area(); no sum changes.
  void set_denoised(std::vector<float> radiance);
  bool denoised() const { return !denoised_.empty(); }

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
  struct Position {
    std::int64_t sums[3] = {};
  };
  // In 2^-64.
  struct Squares {
    WideSum sums[3] = {};
  };
  // The radiance of one stage, [y][x]; a layer that is not kept has none. Odd halves are of a film of one stage.
  struct Stage {
    std::vector<Pixel> pixels;
    std::vector<Squares> squares;
    std::vector<OddHalf> odd_halves;
  };
  // Of the sample `number`; all bits set when none hit.
  struct Ids {
    std::uint32_t number = ~0u, surface = kNoId, material = kNoId;
    auto operator<=>(const Ids&) const = default;
  };
  // Plain sums: 64 bits of instructions take a pixel a lifetime.
  struct Cost {
    std::uint64_t evaluations = 0, instructions = 0;
  };

  static constexpr std::size_t kSeenStages = 2;  // of those that means() looks at
  std::span<const Stage> seen_stages() const {
    return std::span(stages_).first(std::min(kSeenStages, stages_.size()));
  }
  template <class Self, class Sink>
  static void visit_pixel(Self& film, std::size_t at, Sink&& sink);
  bool add_squares(Squares& squares, glm::vec3 radiance);
  bool add_first_hit(std::size_t at, const PathSample& sample);
  // Of a row of pixels.
  bool merge_stage(const Film& part, Stage& stage, std::size_t from, std::size_t to, std::size_t count);
  bool merge_rest(const Film& part, std::size_t from, std::size_t to, std::size_t count);
  RadianceMeans means_of(const Pixel& pixel, const Squares& squares, const OddHalf& odd) const;
  void read_radiance(int x, int y, PixelMeans& means) const;
  void read_first_hit(std::size_t at, PixelMeans& means) const;

  PixelRect area_;
  FilmLayers layers_;
  std::vector<Stage> stages_;  // 1, 2 or 4
  // [y][x], of both stages; a layer that is not kept has none.
  std::vector<FirstHit> first_hits_;
  std::vector<Position> positions_;
  std::vector<Ids> ids_;
  std::vector<Cost> costs_;
  std::vector<float> denoised_;  // [y][x][rgb]; empty until there is one
};

}  // namespace fathom::runtime
