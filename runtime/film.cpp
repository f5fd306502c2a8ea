#include "runtime/film.h"

#include <limits>

namespace fathom::runtime {
namespace {

constexpr double kUnit = 0x1p-32;
constexpr std::int64_t kFull = std::numeric_limits<std::int64_t>::max();

// Nearest multiple of 2^-32; `value` must be finite. Half-way cases go away from zero.
std::int64_t to_fixed(double value) {
  const double scaled = value / kUnit;
  if (scaled >= 0x1p63) return kFull;
  if (scaled <= -0x1p63) return -kFull;
  return static_cast<std::int64_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
}

bool accumulate(std::int64_t& sum, double value) {
  const std::int64_t term = to_fixed(value);
  std::int64_t result;
  if (!__builtin_add_overflow(sum, term, &result)) {
    sum = result;
    return term != kFull && term != -kFull;
  }
  sum = term > 0 ? kFull : -kFull;
  return false;
}

}  // namespace

Film::Film(int width, int height)
    : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

bool Film::add(int x, int y, const PathSample& sample) {
  Pixel& pixel =
      pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  ++pixel.samples;
  bool room = true;
  for (int i = 0; i < 3; ++i) room &= accumulate(pixel.sums[Red + i], sample.radiance[i]);
  if (!sample.hit) return room;
  ++pixel.hits;
  for (int i = 0; i < 3; ++i) room &= accumulate(pixel.sums[AlbedoR + i], sample.albedo[i]);
  for (int i = 0; i < 3; ++i) room &= accumulate(pixel.sums[NormalX + i], sample.normal[i]);
  return accumulate(pixel.sums[Depth], sample.depth) && room;
}

PixelMeans Film::means(int x, int y) const {
  const Pixel& pixel =
      pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  PixelMeans means;
  means.hits = pixel.hits;
  means.samples = pixel.samples;
  if (pixel.samples == 0) return means;
  const auto mean = [&](int channel, std::uint32_t count) {
    return static_cast<double>(pixel.sums[channel]) * kUnit / count;
  };
  for (int i = 0; i < 3; ++i) {
    means.radiance[i] = mean(Red + i, pixel.samples);
    means.albedo[i] = mean(AlbedoR + i, pixel.samples);
    means.normal[i] = mean(NormalX + i, pixel.samples);
  }
  if (pixel.hits > 0) means.depth = mean(Depth, pixel.hits);
  return means;
}

std::uint64_t Film::hash() const {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto absorb = [&](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3u; };
  for (const Pixel& pixel : pixels_) {
    for (const std::int64_t sum : pixel.sums) absorb(static_cast<std::uint64_t>(sum));
    absorb(static_cast<std::uint64_t>(pixel.hits) << 32 | pixel.samples);
  }
  return hash;
}

}  // namespace fathom::runtime
