// Converts the film's sums to the bytes of film files and back (docs/reference/film-file.md).
// Tested by: tests/runtime/film/film_file_test.cpp
#include "runtime/film/film.h"
#include "vm/encoding/bytes.h"

namespace fathom::runtime {
namespace {

// visit_pixel() passes each sum of a pixel to a Sink, in the same order for both directions: Writing writes the sum,
// Reading fills the sum in.
struct SumWriter {
  vm::ByteWriter& bytes;

  void operator()(std::uint32_t value) { bytes.u32(value); }
  void operator()(std::uint64_t value) { bytes.u64(value); }
  void operator()(std::int64_t value) { bytes.u64(static_cast<std::uint64_t>(value)); }
  void operator()(WideSum value) {
    bytes.u64(static_cast<std::uint64_t>(value));
    bytes.u64(static_cast<std::uint64_t>(value >> 64));
  }
  template <class Sum>
  void operator()(const Sum (&sums)[3]) {
    for (const Sum sum : sums) (*this)(sum);
  }
};

struct SumReader {
  vm::ByteReader& bytes;

  void operator()(std::uint32_t& value) { value = bytes.u32(); }
  void operator()(std::uint64_t& value) { value = bytes.u64(); }
  void operator()(std::int64_t& value) { value = static_cast<std::int64_t>(bytes.u64()); }
  void operator()(WideSum& value) {
    value = bytes.u64();
    value |= WideSum{bytes.u64()} << 64;
  }
  template <class Sum>
  void operator()(Sum (&sums)[3]) {
    for (Sum& sum : sums) (*this)(sum);
  }
};

}  // namespace

template <class Self, class Sink>
void Film::visit_pixel(Self& film, std::size_t at, Sink&& sink) {
  for (auto& stage : film.stages_) {
    sink(stage.pixels[at].radiance);
    sink(stage.pixels[at].hits);
    sink(stage.pixels[at].samples);
    if (film.layers_.variance) sink(stage.squares[at].sums);
    if (stage.odd_halves.empty()) continue;
    sink(stage.odd_halves[at].radiance);
    sink(stage.odd_halves[at].samples);
  }
  if (film.layers_.first_hit) {
    sink(film.first_hits_[at].albedo);
    sink(film.first_hits_[at].normal);
    sink(film.first_hits_[at].depth);
  }
  if (film.layers_.position) sink(film.positions_[at].sums);
  if (film.layers_.ids) {
    sink(film.ids_[at].number);
    sink(film.ids_[at].surface);
    sink(film.ids_[at].material);
  }
  if (film.layers_.cost) {
    sink(film.costs_[at].evaluations);
    sink(film.costs_[at].instructions);
  }
}

void Film::write_sums(PixelRect rect, vm::ByteWriter& out) const {
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) visit_pixel(*this, area_.index(x, y), SumWriter{out});
  }
}

bool Film::read_sums(PixelRect rect, vm::ByteReader& in) {
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) visit_pixel(*this, area_.index(x, y), SumReader{in});
  }
  return !in.failed();
}

std::size_t Film::file_bytes_per_pixel(FilmLayers layers, std::size_t stages) {
  constexpr std::size_t kSums = 3 * sizeof(std::int64_t), kCount = sizeof(std::uint32_t);
  const std::size_t stage = kSums + 2 * kCount + (layers.variance ? 3 * sizeof(WideSum) : 0);
  return stages * stage + (layers.halves ? kSums + kCount : 0) +
         (layers.first_hit ? 2 * kSums + sizeof(std::int64_t) : 0) + (layers.position ? kSums : 0) +
         (layers.ids ? 3 * kCount : 0) + (layers.cost ? 2 * sizeof(std::uint64_t) : 0);
}

}  // namespace fathom::runtime
