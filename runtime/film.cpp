#include "runtime/film.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "vm/check.h"

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

template <typename Vector>
bool accumulate(std::int64_t (&sums)[3], Vector values) {
  bool room = true;
  for (int i = 0; i < 3; ++i) room &= accumulate(sums[i], static_cast<double>(values[i]));
  return room;
}

double mean(std::int64_t sum, std::uint32_t count) { return static_cast<double>(sum) * kUnit / count; }

glm::dvec3 mean(const std::int64_t (&sums)[3], std::uint32_t count) {
  return {mean(sums[0], count), mean(sums[1], count), mean(sums[2], count)};
}

WideSum square(std::int64_t value) {
  const WideSum magnitude = static_cast<std::uint64_t>(value < 0 ? -value : value);
  return magnitude * magnitude;
}

// Variance of the mean of n values, s^2/n with s^2 = (n * sum of squares - (sum)^2) / (n (n - 1)): in whole numbers,
// so that what cancels leaves no error, unless a square is beyond them.
double variance_of_mean(std::int64_t sum, WideSum squares, std::uint32_t count) {
  if (count < 2) return 0;
  const double n = count;
  const WideSum squared_sum = square(sum);
  WideSum scaled;
  double spread;
  if (__builtin_mul_overflow(squares, static_cast<WideSum>(count), &scaled)) {
    spread = static_cast<double>(squares) * n - static_cast<double>(squared_sum);
  } else {
    spread = scaled > squared_sum ? static_cast<double>(scaled - squared_sum) : 0;  // a full sum may be less
  }
  return std::max(0.0, spread) * kUnit * kUnit / (n * n * (n - 1));
}

}  // namespace

Film::Film(PixelRect area, FilmLayers layers) : area_(area), layers_(layers) {
  const std::size_t count = area.pixels();
  pixels_.resize(count);
  if (layers.first_hit) first_hits_.resize(count);
  if (layers.position) positions_.resize(count);
  if (layers.ids) ids_.resize(count);
  if (layers.variance) squares_.resize(count);
  if (layers.cost) costs_.resize(count);
  if (layers.halves) odd_halves_.resize(count);
}

bool Film::add(int x, int y, const PathSample& sample) {
  const std::size_t at = area_.index(x, y);
  Pixel& pixel = pixels_[at];
  ++pixel.samples;
  bool room = accumulate(pixel.radiance, sample.radiance);
  if (layers_.variance) room &= add_squares(at, sample.radiance);
  if (layers_.cost) {
    costs_[at].evaluations += sample.evaluations;
    costs_[at].instructions += sample.instructions;
  }
  if (layers_.halves && sample.number % 2 == 1) {
    ++odd_halves_[at].samples;
    room &= accumulate(odd_halves_[at].radiance, sample.radiance);
  }
  if (!sample.hit) return room;
  ++pixel.hits;
  return add_first_hit(at, sample) && room;
}

bool Film::add_squares(std::size_t at, glm::vec3 radiance) {
  bool room = true;
  for (int i = 0; i < 3; ++i) {
    WideSum& sum = squares_[at].sums[i];
    if (!__builtin_add_overflow(sum, square(to_fixed(static_cast<double>(radiance[i]))), &sum)) continue;
    sum = ~WideSum{0};
    room = false;
  }
  return room;
}

bool Film::add_first_hit(std::size_t at, const PathSample& sample) {
  bool room = true;
  if (layers_.first_hit) {
    FirstHit& first = first_hits_[at];
    room &= accumulate(first.albedo, sample.albedo);
    room &= accumulate(first.normal, sample.normal);
    room &= accumulate(first.depth, sample.depth);
  }
  if (layers_.position) room &= accumulate(positions_[at].sums, sample.position);
  if (layers_.ids) ids_[at] = std::min(ids_[at], Ids{sample.number, sample.surface, sample.material});
  return room;
}

PixelMeans Film::means(int x, int y) const {
  const std::size_t at = area_.index(x, y);
  const Pixel& pixel = pixels_[at];
  PixelMeans means;
  means.hits = pixel.hits;
  means.samples = pixel.samples;
  if (pixel.samples == 0) return means;
  means.radiance = means.noisy = mean(pixel.radiance, pixel.samples);
  if (denoised()) means.radiance = {denoised_[3 * at], denoised_[3 * at + 1], denoised_[3 * at + 2]};
  if (layers_.variance) {
    for (int i = 0; i < 3; ++i) {
      means.variance[i] = variance_of_mean(pixel.radiance[i], squares_[at].sums[i], pixel.samples);
    }
  }
  if (layers_.halves) read_halves(at, means);
  if (layers_.cost) {
    means.evaluations = static_cast<double>(costs_[at].evaluations) / pixel.samples;
    means.instructions = static_cast<double>(costs_[at].instructions) / pixel.samples;
  }
  if (pixel.hits > 0) read_first_hit(at, means);
  return means;
}

void Film::read_halves(std::size_t at, PixelMeans& means) const {
  const Pixel& pixel = pixels_[at];
  const OddHalf& odd = odd_halves_[at];
  const std::uint32_t even = pixel.samples - odd.samples;
  for (int i = 0; i < 3; ++i) {
    // In double, for full sums may be further apart than 64 bits reach.
    const double rest = static_cast<double>(pixel.radiance[i]) - static_cast<double>(odd.radiance[i]);
    if (even > 0) means.halves[0][i] = rest * kUnit / even;
  }
  if (odd.samples > 0) means.halves[1] = mean(odd.radiance, odd.samples);
}

void Film::read_first_hit(std::size_t at, PixelMeans& means) const {
  if (layers_.first_hit) {
    const FirstHit& first = first_hits_[at];
    means.albedo = mean(first.albedo, means.samples);
    means.normal = mean(first.normal, means.samples);
    means.depth = mean(first.depth, means.hits);
  }
  if (layers_.position) means.position = mean(positions_[at].sums, means.hits);
  if (layers_.ids) {
    means.surface_id = ids_[at].surface + 1;
    means.material_id = ids_[at].material + 1;
  }
}

void Film::set_denoised(std::vector<float> radiance) {
  CHECK(radiance.size() == 3 * pixels_.size(), "a denoised picture of another size than its film");
  denoised_ = std::move(radiance);
}

std::uint64_t Film::hash() const {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto absorb = [&](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3u; };
  const auto absorb_sums = [&](const std::int64_t(&sums)[3]) {
    for (const std::int64_t sum : sums) absorb(static_cast<std::uint64_t>(sum));
  };
  for (const Pixel& pixel : pixels_) {
    absorb_sums(pixel.radiance);
    absorb(static_cast<std::uint64_t>(pixel.hits) << 32 | pixel.samples);
  }
  for (const FirstHit& first : first_hits_) {
    absorb_sums(first.albedo);
    absorb_sums(first.normal);
    absorb(static_cast<std::uint64_t>(first.depth));
  }
  for (const OddHalf& half : odd_halves_) {
    absorb_sums(half.radiance);
    absorb(half.samples);
  }
  for (const Position& position : positions_) absorb_sums(position.sums);
  for (const Ids& ids : ids_) {
    for (const std::uint32_t id : {ids.number, ids.surface, ids.material}) absorb(id);
  }
  for (const Squares& squares : squares_) {
    for (const WideSum sum : squares.sums) {
      absorb(static_cast<std::uint64_t>(sum));
      absorb(static_cast<std::uint64_t>(sum >> 64));
    }
  }
  return hash;
}

}  // namespace fathom::runtime
