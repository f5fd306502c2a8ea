// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/sampling/sampler_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/sampling/sampler_lanes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

#ifndef FATHOM_SAMPLER_KERNEL
#define FATHOM_SAMPLER_KERNEL
namespace fathom::runtime {

// The rows that a kernel reads.
struct SamplerKernel {
  explicit SamplerKernel(const SamplerRows& rows)
      : kind(rows.kind_),
        unused_bits(rows.unused_bits_),
        pixel_bits(rows.pixel_bits_),
        key(rows.key_),
        index(rows.index_),
        dimension(rows.dimension_) {}

  SamplerKind kind;
  int unused_bits, pixel_bits;
  const std::uint64_t* key;
  const std::uint32_t *index, *dimension;
};

}  // namespace fathom::runtime
#endif

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Words = hn::ScalableTag<std::uint32_t>;
using LongWords = hn::ScalableTag<std::uint64_t>;
using Word = hn::Vec<Words>;
using LongWord = hn::Vec<LongWords>;

HWY_INLINE Word word(std::uint32_t value) { return hn::Set(Words(), value); }
HWY_INLINE LongWord long_word(std::uint64_t value) { return hn::Set(LongWords(), value); }

HWY_INLINE LongWord mixed(LongWord z) {
  z = hn::Xor(z, hn::ShiftRight<30>(z)) * long_word(0xbf58476d1ce4e5b9u);
  z = hn::Xor(z, hn::ShiftRight<27>(z)) * long_word(0x94d049bb133111ebu);
  return hn::Xor(z, hn::ShiftRight<31>(z));
}

HWY_INLINE Word swapped(Word v, int bits, std::uint32_t low) {
  return hn::Or(hn::And(hn::ShiftRightSame(v, bits), word(low)), hn::ShiftLeftSame(hn::And(v, word(low)), bits));
}
HWY_INLINE Word reversed_lanes(Word v) {
  v = swapped(v, 1, 0x55555555u);
  v = swapped(v, 2, 0x33333333u);
  v = swapped(v, 4, 0x0f0f0f0fu);
  v = swapped(v, 8, 0x00ff00ffu);
  return hn::Or(hn::ShiftRight<16>(v), hn::ShiftLeft<16>(v));
}

HWY_INLINE Word scrambled(Word v, Word seed) {
  v = hn::Xor(v, v * word(0x3d20adeau));
  v = hn::Add(v, seed);
  v = v * hn::Or(hn::ShiftRight<16>(seed), word(1));
  v = hn::Xor(v, v * word(0x05526c56u));
  return hn::Xor(v, v * word(0x53a22864u));
}

HWY_INLINE Word sobol_second_lanes(Word index) {
  index = hn::Xor(index, hn::And(hn::ShiftRight<1>(index), word(0x55555555u)));
  index = hn::Xor(index, hn::And(hn::ShiftRight<2>(index), word(0x33333333u)));
  index = hn::Xor(index, hn::And(hn::ShiftRight<4>(index), word(0x0f0f0f0fu)));
  index = hn::Xor(index, hn::And(hn::ShiftRight<8>(index), word(0x00ff00ffu)));
  return hn::Xor(index, hn::ShiftRight<16>(index));
}

// As Sampler::rotated().
HWY_INLINE Word rotated_lanes(Word v, Word seed, int pixel_bits) {
  const Word odd = word(0x55555555u),
             pixels = word(static_cast<std::uint32_t>((1ull << pixel_bits) - 1) & 0x55555555u);
  const Word spread = hn::Add(v, hn::Not(seed)) * word(0x9e3779b1u);
  const Word hash = hn::ShiftLeft<2>(hn::Xor(spread, spread * word(0x3d20adeau)));
  const Word next = hn::ShiftRight<1>(hash);
  const Word once = hn::And(hn::AndNot(next, hash), pixels), twice = hn::And(hn::AndNot(hash, next), pixels);
  const Word a = hn::And(v, odd), b = hn::And(hn::ShiftRight<1>(v), odd), both = hn::Xor(a, b);
  const Word first = hn::Xor(a, hn::Xor(hn::And(both, once), hn::And(b, twice)));
  const Word second = hn::Xor(b, hn::Xor(hn::And(a, once), hn::And(both, twice)));
  return hn::Or(first, hn::ShiftLeft<1>(second));
}

// Multiples of 2^-24 in [0,1), from the highest bits.
HWY_INLINE void store_unit(Word bits, float* to) {
  const hn::ScalableTag<float> floats;
  const hn::RebindToSigned<Words> ints;
  const auto number = hn::ConvertTo(floats, hn::BitCast(ints, hn::ShiftRight<8>(bits)));
  hn::StoreU(hn::Mul(number, hn::Set(floats, 0x1p-24f)), floats, to);
}

// Writes the hash of number `ahead` after those that each sampler has drawn.
HWY_INLINE void hash_dimensions(const SamplerKernel& rows, std::size_t count, std::uint32_t ahead,
                                std::uint64_t* to) {
  const LongWords d;
  const hn::Rebind<std::uint32_t, LongWords> narrow;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const LongWord dimension = hn::Add(hn::PromoteTo(d, hn::LoadU(narrow, rows.dimension + i)), long_word(ahead));
    hn::StoreU(mixed(hn::Add(hn::LoadU(d, rows.key + i), dimension * long_word(kGoldenGamma))), d, to + i);
  }
}

// Draws pairs. `v` null: draws only their first numbers.
HWY_INLINE void draw_spread(const SamplerKernel& rows, std::size_t count, float* u, float* v) {
  alignas(64) std::uint64_t hashes[SamplerRows::kCapacity], products[SamplerRows::kCapacity];
  hash_dimensions(rows, count, 1, hashes);
  const LongWords wide;
  for (std::size_t i = 0; v && i < count; i += hn::Lanes(wide)) {
    hn::StoreU(hn::LoadU(wide, hashes + i) * long_word(0xd1342543de82ef95u), wide, products + i);
  }
  const Words d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    Word seed, first_seed, unused, second_seed;
    hn::LoadInterleaved2(d, reinterpret_cast<const std::uint32_t*>(hashes + i), seed, first_seed);
    const Word index = hn::LoadU(d, rows.index + i);
    const Word digits = rows.kind == SamplerKind::Blue ? rotated_lanes(index, seed, rows.pixel_bits) : index;
    const Word shuffled = hn::ShiftRightSame(reversed_lanes(scrambled(digits, seed)), rows.unused_bits);
    store_unit(reversed_lanes(scrambled(shuffled, first_seed)), u + i);
    if (!v) continue;
    hn::LoadInterleaved2(d, reinterpret_cast<const std::uint32_t*>(products + i), unused, second_seed);
    store_unit(reversed_lanes(scrambled(sobol_second_lanes(shuffled), second_seed)), v + i);
  }
}

HWY_INLINE void draw_independent(const SamplerKernel& rows, std::size_t count, std::uint32_t ahead, float* u) {
  alignas(64) std::uint64_t hashes[SamplerRows::kCapacity];
  hash_dimensions(rows, count, ahead, hashes);
  const Words d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    Word low, high;
    hn::LoadInterleaved2(d, reinterpret_cast<const std::uint32_t*>(hashes + i), low, high);
    store_unit(high, u + i);
  }
}

void draw_lanes(const SamplerKernel& rows, std::size_t count, float* u, float* v) {
  if (rows.kind != SamplerKind::Independent) return draw_spread(rows, count, u, v);
  draw_independent(rows, count, 1, u);
  if (v) draw_independent(rows, count, 2, v);
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(draw_lanes);

void SamplerRows::draw_pairs(std::size_t count, float* u, float* v) const {
  HWY_DYNAMIC_DISPATCH(draw_lanes)(SamplerKernel(*this), count, u, v);
}
void SamplerRows::draw(std::size_t count, float* u) const {
  HWY_DYNAMIC_DISPATCH(draw_lanes)(SamplerKernel(*this), count, u, nullptr);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
