// A register of lanes: a view of the arrays of lane_rows.h. N is vm's Batch (f32 lanes) or Real (one double).
#if defined(FATHOM_RUNTIME_LANE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_RUNTIME_LANE_INL
#undef FATHOM_RUNTIME_LANE_INL
#else
#define FATHOM_RUNTIME_LANE_INL
#endif

#include <limits>
#include <type_traits>
#include <utility>

#include "runtime/march/lane_rows.h"
#include "vm/number/batch-inl.h"
#include "vm/number/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

using vm::HWY_NAMESPACE::any;  // of a bool
using vm::HWY_NAMESPACE::Batch;
using vm::HWY_NAMESPACE::Real;

template <class N>
using MaskOf = decltype(std::declval<N>() < std::declval<N>());

HWY_INLINE Batch load(const float* from, Batch*) { return Batch::load(from); }
HWY_INLINE Real load(const double* from, Real*) { return {*from}; }
HWY_INLINE void store(Batch a, float* to) { a.store(to); }
HWY_INLINE void store(Real a, double* to) { *to = a.v; }

// Returns the mask as bits: bit i is lane i.
HWY_INLINE std::uint32_t lanes_of(vm::HWY_NAMESPACE::BatchMask mask) {
  std::conditional_t<(sizeof(Batch) > 32), std::uint16_t, std::uint8_t> bits = 0;
  hwy::HWY_NAMESPACE::StoreMaskBits(vm::HWY_NAMESPACE::FloatLanes(), mask.m, reinterpret_cast<std::uint8_t*>(&bits));
  return bits;
}
HWY_INLINE std::uint32_t lanes_of(bool mask) { return mask; }

template <class N>
HWY_INLINE N number(double value) {
  return N::broadcast(value);
}
template <class N, class Enum>
HWY_INLINE N code(Enum value) {
  return number<N>(static_cast<double>(value));
}

// Returns 1 / a, or less by up to 7 parts per million, where a division would cost three times as much. The bits of a
// float are nearly its logarithm (Blinn, "Floating-Point Tricks", IEEE CG&A 1997), so a difference of bits is nearly
// a quotient. Two Newton steps follow. Plain arithmetic alone gives the same bits on every machine.
HWY_INLINE Batch rough_reciprocal(Batch a) {
  const vm::HWY_NAMESPACE::FloatLanes floats;
  const hwy::HWY_NAMESPACE::RebindToSigned<vm::HWY_NAMESPACE::FloatLanes> ints;
  const auto mirrored =
      hwy::HWY_NAMESPACE::Sub(hwy::HWY_NAMESPACE::Set(ints, 0x7ef311c7), hwy::HWY_NAMESPACE::BitCast(ints, a.v));
  Batch inverse{hwy::HWY_NAMESPACE::BitCast(floats, mirrored)};
  for (int i = 0; i < 2; ++i) inverse = inverse * (number<Batch>(2) - a * inverse);
  return inverse;
}
HWY_INLINE Real rough_reciprocal(Real a) { return number<Real>(1) / a; }

// The lanes of one register, with the rules common to all methods. A put() with a mask leaves other lanes unchanged.
template <class N, class L>
class LaneView {
 public:
  using Mask = MaskOf<N>;

  HWY_INLINE LaneView(L& lanes, std::size_t first) : lanes_(lanes), first_(first) {}

  // Row: an enum of lane_rows.h.
  template <class Row>
  HWY_INLINE N get(Row row) const {
    return load(&lanes_.row[row][first_], static_cast<N*>(nullptr));
  }
  template <class Row>
  HWY_INLINE void put(Row row, N value) {
    store(value, &lanes_.row[row][first_]);
  }
  template <class Row>
  HWY_INLINE void put(Row row, Mask where, N value) {
    put(row, select(where, value, get(row)));
  }

  // Sets the next t and the verdict, and requests the field at that t. Returns the lanes that have ended.
  HWY_INLINE Mask finish(N t, N verdict) {
    put(kTNext, t);
    put(kX, get(kOx) + t * get(kDx));
    put(kY, get(kOy) + t * get(kDy));
    put(kZ, get(kOz) + t * get(kDz));
    put(kVerdict, verdict);
    return verdict > number<N>(0);
  }

 private:
  L& lanes_;
  std::size_t first_;
};

// New values of the rows with several meanings, in registers until store().
template <class N>
class SharedRows {
 public:
  template <class Row>
  HWY_INLINE N get(Row row) const {
    return value_[index(row)];
  }
  template <class Row>
  HWY_INLINE void put(Row row, N value) {
    value_[index(row)] = value;
  }
  template <class Row>
  HWY_INLINE void put(Row row, MaskOf<N> where, N value) {
    put(row, select(where, value, get(row)));
  }
  // One by one: g++ 12 keeps the values in memory when a loop over the rows stores them.
  template <class View>
  HWY_INLINE void store(View& lanes) const {
    static_assert(kSharedRows == 6);
    lanes.put(kT, get(kT));
    lanes.put(kG, get(kG));
    lanes.put(kR, get(kR));
    lanes.put(kM, get(kM));
    lanes.put(kBackoffCount, get(kBackoffCount));
    lanes.put(kBackoff, get(kBackoff));
  }

 private:
  template <class Row>
  static constexpr std::size_t index(Row row) {
    return static_cast<std::size_t>(row) - kT;
  }
  N value_[kSharedRows];
};

// Returns d_f (field.h), the error bound of f at the lanes' points.
template <class N, class L, class S>
HWY_INLINE N distance_error(const LaneView<N, L>& lanes, N f, const LaneRules<S>& rules) {
  const N place = max(abs(lanes.get(kX)), max(abs(lanes.get(kY)), abs(lanes.get(kZ))));
  const N scale = max(number<N>(1), max(place, abs(f)));
  return N::broadcast(rules.unit) * (scale + N::broadcast(rules.cancellation));
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
