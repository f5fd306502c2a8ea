#include "runtime/film/film.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

constexpr double kUnit = kFilmStep;
constexpr std::int64_t kFull = std::numeric_limits<std::int64_t>::max();

// Returns the nearest multiple of 2^-32, clamped. `value` must be finite. Ties round away from zero.
std::int64_t to_fixed(double value) {
  const double scaled = value / kUnit;
  if (scaled >= 0x1p63) return kFull;
  if (scaled <= -0x1p63) return -kFull;
  return static_cast<std::int64_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
}

// Adds and clamps. Returns false if the sum or the term is clamped.
bool add_to(std::int64_t& sum, std::int64_t term) {
  std::int64_t result;
  if (!__builtin_add_overflow(sum, term, &result)) {
    sum = result;
    return term != kFull && term != -kFull;
  }
  sum = term > 0 ? kFull : -kFull;
  return false;
}

bool add_to(WideSum& sum, WideSum term) {
  if (!__builtin_add_overflow(sum, term, &sum)) return true;
  sum = ~WideSum{0};
  return false;
}

template <typename Sum>
bool add_to(Sum (&sums)[3], const Sum (&terms)[3]) {
  bool room = true;
  for (int i = 0; i < 3; ++i) room &= add_to(sums[i], terms[i]);
  return room;
}

bool accumulate(std::int64_t& sum, double value) { return add_to(sum, to_fixed(value)); }

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
  const auto bits = static_cast<std::uint64_t>(value);
  const WideSum magnitude = value < 0 ? -bits : bits;
  return magnitude * magnitude;
}

// Returns the variance of the mean of n values, s^2/n with s^2 = (n * sum of squares - (sum)^2) / (n (n - 1)).
// Integers make the cancellation exact, unless n times the sum of squares overflows 128 bits.
double variance_of_mean(std::int64_t sum, WideSum squares, std::uint32_t count) {
  if (count < 2) return 0;
  const double n = count;
  const WideSum squared_sum = square(sum);
  WideSum scaled;
  double spread;
  if (__builtin_mul_overflow(squares, static_cast<WideSum>(count), &scaled)) {
    spread = static_cast<double>(squares) * n - static_cast<double>(squared_sum);
  } else {
    spread = scaled > squared_sum ? static_cast<double>(scaled - squared_sum) : 0;  // negative only if clamped
  }
  return std::max(0.0, spread) * kUnit * kUnit / (n * n * (n - 1));
}

}  // namespace

Film::Film(PixelRect area, FilmLayers layers) : layers_(layers) { restart(area); }

void Film::restart(PixelRect area) {
  const auto empty = [&](auto& sums, bool kept) {
    sums.clear();
    if (kept) sums.resize(area.pixels());
  };
  area_ = area;
  stages_.resize(1);
  empty(stages_.front().pixels, true);
  empty(stages_.front().squares, layers_.variance);
  empty(stages_.front().odd_halves, layers_.halves);
  empty(first_hits_, layers_.first_hit);
  empty(positions_, layers_.position);
  empty(ids_, layers_.ids);
  empty(costs_, layers_.cost);
  denoised_.clear();
}

void Film::add_stage() {
  CHECK(stages_.size() == 1 && samples() == 0, "a stage is added to an empty film");
  stages_.push_back({stages_.front().pixels, stages_.front().squares, {}});
}

bool Film::add(int x, int y, const PathSample& sample) {
  const std::size_t at = area_.index(x, y);
  Stage& stage = stages_.front();
  Pixel& pixel = stage.pixels[at];
  ++pixel.samples;
  bool room = accumulate(pixel.radiance, sample.radiance);
  if (layers_.variance) room &= add_squares(stage.squares[at], sample.radiance);
  if (layers_.cost) {
    costs_[at].evaluations += sample.evaluations;
    costs_[at].instructions += sample.instructions;
  }
  if (layers_.halves && sample.number % 2 == 1) {
    OddHalf& odd = stage.odd_halves[at];
    ++odd.samples;
    room &= accumulate(odd.radiance, sample.radiance);
  }
  if (!sample.hit) return room;
  ++pixel.hits;
  return add_first_hit(at, sample) && room;
}

bool Film::add_squares(Squares& squares, glm::vec3 radiance) {
  bool room = true;
  for (int i = 0; i < 3; ++i) {
    room &= add_to(squares.sums[i], square(to_fixed(static_cast<double>(radiance[i]))));
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

bool Film::merge(const Film& part, std::size_t stage) {
  CHECK(part.stages_.size() == 1 && part.layers_ == layers_ && stage < stages_.size(), "films that do not fit");
  const PixelRect rows = part.area_;
  bool room = true;
  for (int y = rows.y0; y < rows.y1; ++y) {
    const std::size_t from = rows.index(rows.x0, y), to = area_.index(rows.x0, y);
    const auto count = static_cast<std::size_t>(rows.width());
    room &= merge_stage(part, stages_[stage], from, to, count);
    if (stage == 0) room &= merge_rest(part, from, to, count);
  }
  return room;
}

bool Film::merge_stage(const Film& part, Stage& stage, std::size_t from, std::size_t to, std::size_t count) {
  const Stage& other = part.stages_.front();
  bool room = true;
  for (std::size_t i = 0; i < count; ++i) {
    const Pixel& term = other.pixels[from + i];
    Pixel& pixel = stage.pixels[to + i];
    pixel.samples += term.samples;
    pixel.hits += term.hits;
    room &= add_to(pixel.radiance, term.radiance);
  }
  for (std::size_t i = 0; layers_.variance && i < count; ++i) {
    room &= add_to(stage.squares[to + i].sums, other.squares[from + i].sums);
  }
  for (std::size_t i = 0; !stage.odd_halves.empty() && i < count; ++i) {
    stage.odd_halves[to + i].samples += other.odd_halves[from + i].samples;
    room &= add_to(stage.odd_halves[to + i].radiance, other.odd_halves[from + i].radiance);
  }
  return room;
}

// Merges the sums that only stage 0 has.
bool Film::merge_rest(const Film& part, std::size_t from, std::size_t to, std::size_t count) {
  bool room = true;
  for (std::size_t i = 0; layers_.first_hit && i < count; ++i) {
    const FirstHit& term = part.first_hits_[from + i];
    FirstHit& sum = first_hits_[to + i];
    room &= add_to(sum.albedo, term.albedo);
    room &= add_to(sum.normal, term.normal);
    room &= add_to(sum.depth, term.depth);
  }
  for (std::size_t i = 0; layers_.position && i < count; ++i) {
    room &= add_to(positions_[to + i].sums, part.positions_[from + i].sums);
  }
  for (std::size_t i = 0; layers_.ids && i < count; ++i) ids_[to + i] = std::min(ids_[to + i], part.ids_[from + i]);
  for (std::size_t i = 0; layers_.cost && i < count; ++i) {
    costs_[to + i].evaluations += part.costs_[from + i].evaluations;
    costs_[to + i].instructions += part.costs_[from + i].instructions;
  }
  return room;
}

PixelMeans Film::means(int x, int y) const {
  const std::size_t at = area_.index(x, y);
  PixelMeans means;
  means.hits = stages_.front().pixels[at].hits;
  means.samples = stages_.front().pixels[at].samples;
  if (means.samples == 0) return means;
  read_radiance(at, means);
  if (layers_.cost) {
    means.evaluations = static_cast<double>(costs_[at].evaluations) / means.samples;
    means.instructions = static_cast<double>(costs_[at].instructions) / means.samples;
  }
  if (means.hits > 0) read_first_hit(at, means);
  return means;
}

std::size_t Film::memory_per_pixel(FilmLayers layers, std::size_t stages) {
  const std::size_t stage = sizeof(Pixel) + (layers.variance ? sizeof(Squares) : 0);
  return stages * stage + (layers.halves ? sizeof(OddHalf) : 0) + (layers.first_hit ? sizeof(FirstHit) : 0) +
         (layers.position ? sizeof(Position) : 0) + (layers.ids ? sizeof(Ids) : 0) + (layers.cost ? sizeof(Cost) : 0);
}

std::uint32_t Film::samples(int x, int y) const { return stages_.front().pixels[area_.index(x, y)].samples; }

std::uint64_t Film::samples() const {
  std::uint64_t sum = 0;
  for (const Pixel& pixel : stages_.front().pixels) sum += pixel.samples;
  return sum;
}

RadianceMeans Film::all_radiance(int x, int y) const {
  const std::size_t at = area_.index(x, y);
  Pixel pixel;
  Squares squares;
  for (const Stage& stage : stages_) {
    add_to(pixel.radiance, stage.pixels[at].radiance);
    pixel.samples += stage.pixels[at].samples;
    if (layers_.variance) add_to(squares.sums, stage.squares[at].sums);
  }
  return means_of(pixel, squares);
}

void Film::read_radiance(std::size_t at, PixelMeans& means) const {
  const Stage& stage = stages_.front();
  const Pixel& pixel = stage.pixels[at];
  const RadianceMeans sampled = means_of(pixel, layers_.variance ? stage.squares[at] : Squares());
  means.noisy = means.radiance = sampled.radiance;
  means.variance = sampled.variance;
  if (denoised()) means.radiance = {denoised_[3 * at], denoised_[3 * at + 1], denoised_[3 * at + 2]};
  if (!layers_.halves) return;
  const OddHalf& odd = stage.odd_halves[at];
  if (odd.samples > 0) means.halves[1] = mean(odd.radiance, odd.samples);
  const std::uint32_t even = pixel.samples - odd.samples;
  for (int i = 0; even > 0 && i < 3; ++i) {
    // In double, because the difference of clamped sums may overflow 64 bits.
    const double rest = static_cast<double>(pixel.radiance[i]) - static_cast<double>(odd.radiance[i]);
    means.halves[0][i] = rest * kUnit / even;
  }
}

RadianceMeans Film::means_of(const Pixel& pixel, const Squares& squares) const {
  RadianceMeans means;
  means.samples = pixel.samples;
  if (pixel.samples == 0) return means;
  means.radiance = mean(pixel.radiance, pixel.samples);
  for (int i = 0; layers_.variance && i < 3; ++i) {
    means.variance[i] = variance_of_mean(pixel.radiance[i], squares.sums[i], pixel.samples);
  }
  return means;
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
  CHECK(radiance.size() == 3 * area_.pixels(), "a denoised picture of another size than its film");
  denoised_ = std::move(radiance);
}

std::uint64_t Film::hash() const {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto absorb = [&](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3u; };
  const auto absorb_sums = [&](const std::int64_t(&sums)[3]) {
    for (const std::int64_t sum : sums) absorb(static_cast<std::uint64_t>(sum));
  };
  for (const Stage& stage : stages_) {
    for (const Pixel& pixel : stage.pixels) {
      absorb_sums(pixel.radiance);
      absorb(static_cast<std::uint64_t>(pixel.hits) << 32 | pixel.samples);
    }
    for (const OddHalf& half : stage.odd_halves) {
      absorb_sums(half.radiance);
      absorb(half.samples);
    }
    for (const Squares& squares : stage.squares) {
      for (const WideSum sum : squares.sums) {
        absorb(static_cast<std::uint64_t>(sum));
        absorb(static_cast<std::uint64_t>(sum >> 64));
      }
    }
  }
  for (const FirstHit& first : first_hits_) {
    absorb_sums(first.albedo);
    absorb_sums(first.normal);
    absorb(static_cast<std::uint64_t>(first.depth));
  }
  for (const Position& position : positions_) absorb_sums(position.sums);
  for (const Ids& ids : ids_) {
    for (const std::uint32_t id : {ids.number, ids.surface, ids.material}) absorb(id);
  }
  return hash;
}

}  // namespace fathom::runtime
