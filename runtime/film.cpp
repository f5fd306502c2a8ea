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

bool accumulate(std::int64_t (&sums)[3], glm::vec3 values) {
  bool room = true;
  for (int i = 0; i < 3; ++i) room &= accumulate(sums[i], static_cast<double>(values[i]));
  return room;
}

double mean(std::int64_t sum, std::uint32_t count) { return static_cast<double>(sum) * kUnit / count; }

glm::dvec3 mean(const std::int64_t (&sums)[3], std::uint32_t count) {
  return {mean(sums[0], count), mean(sums[1], count), mean(sums[2], count)};
}

}  // namespace

Film::Film(int width, int height, FilmLayers layers) : width_(width), height_(height), layers_(layers) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  pixels_.resize(count);
  if (layers.first_hit) first_hits_.resize(count);
  if (layers.cost) costs_.resize(count);
  if (layers.halves) odd_halves_.resize(count);
}

bool Film::add(int x, int y, const PathSample& sample) {
  const std::size_t at = index(x, y);
  Pixel& pixel = pixels_[at];
  ++pixel.samples;
  bool room = accumulate(pixel.radiance, sample.radiance);
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
  if (!layers_.first_hit) return room;
  FirstHit& first = first_hits_[at];
  room &= accumulate(first.albedo, sample.albedo);
  room &= accumulate(first.normal, sample.normal);
  return accumulate(first.depth, sample.depth) && room;
}

PixelMeans Film::means(int x, int y) const {
  const std::size_t at = index(x, y);
  const Pixel& pixel = pixels_[at];
  PixelMeans means;
  means.hits = pixel.hits;
  means.samples = pixel.samples;
  if (pixel.samples == 0) return means;
  means.radiance = mean(pixel.radiance, pixel.samples);
  if (layers_.first_hit) {
    const FirstHit& first = first_hits_[at];
    means.albedo = mean(first.albedo, pixel.samples);
    means.normal = mean(first.normal, pixel.samples);
    if (pixel.hits > 0) means.depth = mean(first.depth, pixel.hits);
  }
  if (layers_.halves) read_halves(at, means);
  if (layers_.cost) {
    means.evaluations = static_cast<double>(costs_[at].evaluations) / pixel.samples;
    means.instructions = static_cast<double>(costs_[at].instructions) / pixel.samples;
  }
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

void Film::set_radiance(int x, int y, glm::dvec3 mean) {
  Pixel& pixel = pixels_[index(x, y)];
  for (int i = 0; i < 3; ++i) pixel.radiance[i] = to_fixed(mean[i] * pixel.samples);
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
  return hash;
}

}  // namespace fathom::runtime
