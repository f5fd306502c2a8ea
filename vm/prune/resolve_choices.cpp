// Resolves choices; compiled once per instruction set (Highway's foreach_target).
#include "vm/prune/resolve_choices.h"

#include <limits>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vm/prune/resolve_choices.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

inline constexpr std::size_t kRegisters = kEnclosedBoxes / kLanes;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

HWY_INLINE std::uint32_t bits_of(BatchMask m) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(FloatLanes(), m.m, bytes);
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
}
HWY_INLINE BatchMask mask_of(std::uint32_t bits) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)};
  return {hn::LoadMaskBits(FloatLanes(), bytes)};
}

class ChoiceResolution {
 public:
  HWY_INLINE ChoiceResolution(const ChoiceLink* links, const ChoiceBounds* bounds, float error,
                              DemandedRange* demanded, LiveOperands* kept)
      : links_(links), bounds_(bounds), error_(error), demanded_(demanded), live_(kept) {}

  HWY_INLINE void reset(std::size_t count) {
    const Batch none = Batch::broadcast(kInfinity);
    for (std::size_t j = 0; j < count; ++j) {
      const bool always = links_[j].always;
      // Until choice j is resolved, live_[j].a holds the boxes in which the choice is needed.
      live_[j] = {static_cast<std::uint16_t>(always ? 0xffff : 0), 0};
      for (std::size_t r = 0; r < kRegisters; ++r) {
        (always ? -none : none).store(demanded_[j].lo + r * kLanes);
        (always ? none : -none).store(demanded_[j].hi + r * kLanes);
      }
    }
  }

  // Widens the interest in an operand to include [lo, hi], the interest of one of its users, in the boxes of `bits`.
  HWY_INLINE void pass_on(ChoiceLink::Operand operand, std::size_t r, std::uint32_t bits, Batch lo, Batch hi) {
    if (operand.choice == kNone || bits == 0) return;
    if (operand.less != 0) {  // includes the rounding error of the subtraction
      const Batch less = Batch::broadcast(operand.less), error = Batch::broadcast(0x1p-21f);
      lo = lo + less - error * (abs(lo) + abs(less));
      hi = hi + less + error * (abs(hi) + abs(less));
    }
    DemandedRange& to = demanded_[operand.choice];
    const Batch old_lo = Batch::load(to.lo + r * kLanes), old_hi = Batch::load(to.hi + r * kLanes);
    const BatchMask here = mask_of(bits);
    select(here, min(lo, old_lo), old_lo).store(to.lo + r * kLanes);
    select(here, max(hi, old_hi), old_hi).store(to.hi + r * kLanes);
    std::uint16_t& needed = live_[operand.choice].a;
    needed = static_cast<std::uint16_t>(needed | bits << (r * kLanes));
  }

  // Resolves choice j, whose users are resolved. Signs are changed so that the lesser operand always wins: the
  // maximum of a and b is minus the minimum of -a and -b.
  HWY_INLINE void settle(std::size_t j) {
    const std::uint32_t needed = live_[j].a;
    if (needed == 0) return;
    const ChoiceLink& link = links_[j];
    std::uint32_t kept_a = 0, kept_b = 0;
    for (std::size_t r = 0; r < kRegisters; ++r) {
      const std::uint32_t here = needed >> (r * kLanes) & static_cast<std::uint32_t>((1ull << kLanes) - 1);
      std::uint32_t a = here, b = here;
      if (link.rule == ChoiceRule::Keep) {
        const Batch all = Batch::broadcast(kInfinity);
        pass_on(link.a, r, here, -all, all);
        pass_on(link.b, r, here, -all, all);
      } else {
        settle_lanes(link, j, r, a, b);
      }
      kept_a |= a << (r * kLanes), kept_b |= b << (r * kLanes);
    }
    live_[j] = {static_cast<std::uint16_t>(kept_a), static_cast<std::uint16_t>(kept_b)};
  }

 private:
  HWY_INLINE void settle_lanes(const ChoiceLink& link, std::size_t j, std::size_t r, std::uint32_t& keep_a,
                               std::uint32_t& keep_b) {
    const std::size_t at = r * kLanes;
    const bool turn_a = link.rule == ChoiceRule::Greatest, turn_b = turn_a != link.opposite;
    const ChoiceBounds& of = bounds_[j];
    const Batch a_lo = turn_a ? -Batch::load(of.a_hi + at) : Batch::load(of.a_lo + at);
    const Batch a_hi = turn_a ? -Batch::load(of.a_lo + at) : Batch::load(of.a_hi + at);
    const Batch b_lo = turn_b ? -Batch::load(of.b_hi + at) : Batch::load(of.b_lo + at);
    const Batch b_hi = turn_b ? -Batch::load(of.b_lo + at) : Batch::load(of.b_hi + at);
    const DemandedRange& demanded = demanded_[j];
    const Batch lo = turn_a ? -Batch::load(demanded.hi + at) : Batch::load(demanded.lo + at);
    const Batch hi = turn_a ? -Batch::load(demanded.lo + at) : Batch::load(demanded.hi + at);
    // A blend whose operands are both above T + 5/4 width is above T, because a blend is at most a quarter of its
    // width below the lesser operand.
    const Batch width = Batch::broadcast(link.width), reach = Batch::broadcast(link.width * 1.2501f);
    const Batch limit = min(hi, min(a_hi, b_hi)), all = Batch::broadcast(kInfinity);
    // An operand that may be NaN is never the only one kept, because the choice may then return the other operand.
    const BatchMask number_a = (a_lo > -all) | (a_hi < all), number_b = (b_lo > -all) | (b_hi < all);
    const BatchMask no_a = is_over(a_lo, b_hi, width) | (is_over(a_lo, limit, reach) & number_b);
    const BatchMask no_b = is_over(b_lo, a_hi, width) | (is_over(b_lo, limit, reach) & number_a);
    const BatchMask a_first = a_lo <= b_lo;  // if neither matters, one stays to put the result above the limit
    keep_a &= bits_of((!no_a) | (no_b & a_first));
    keep_b &= bits_of((!no_b) | (no_a & !a_first));
    const Batch most = limit + reach + error_of(limit, reach);
    pass_on(link.a, r, keep_a, turn_a ? -most : lo, turn_a ? -lo : most);
    pass_on(link.b, r, keep_b, turn_b ? -most : lo, turn_b ? -lo : most);
  }

  HWY_INLINE Batch error_of(Batch a, Batch b) const {
    if (error_ == 0) return Batch::broadcast(0.0f);
    return Batch::broadcast(error_) + Batch::broadcast(kResolveShare) * (abs(a) + abs(b));
  }
  // True if a is above b by more than the margin. A rounded difference is above a float only if the exact one is.
  HWY_INLINE BatchMask is_over(Batch a, Batch b, Batch margin) const { return a - b > margin + error_of(a, b); }

  const ChoiceLink* links_;
  const ChoiceBounds* bounds_;
  const float error_;
  DemandedRange* demanded_;
  LiveOperands* live_;
};

void settle_all(const ChoiceLink* links, const ChoiceBounds* bounds, std::size_t count, ChoiceLink::Operand root,
                float least, float most, float error, DemandedRange* demanded, LiveOperands* kept) {
  ChoiceResolution settling(links, bounds, error, demanded, kept);
  settling.reset(count);
  for (std::size_t r = 0; r < kRegisters; ++r) {
    settling.pass_on(root, r, static_cast<std::uint32_t>((1ull << kLanes) - 1), Batch::broadcast(least),
                     Batch::broadcast(most));
  }
  for (std::size_t j = count; j-- > 0;) settling.settle(j);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::vm {

HWY_EXPORT(settle_all);

void resolve_choices(const ChoiceLink* links, const ChoiceBounds* bounds, std::size_t count, ChoiceLink::Operand root,
                     float least, float most, float error, DemandedRange* demanded, LiveOperands* kept) {
  HWY_DYNAMIC_DISPATCH(settle_all)(links, bounds, count, root, least, most, error, demanded, kept);
}

void resolve_pairs(const ChoiceLink* links, const ChoiceRange* ranges, std::size_t count, LiveOperands* kept) {
  for (std::size_t j = 0; j < count; ++j) {
    const ChoiceLink& link = links[j];
    const ChoiceRange& of = ranges[j];
    float a_over_b = -1, b_over_a = -1;  // lower bounds on a - b and b - a
    if (link.rule != ChoiceRule::Keep) {
      const float b_lo = link.opposite ? -of.b_hi : of.b_lo, b_hi = link.opposite ? -of.b_lo : of.b_hi;
      a_over_b = of.a_lo - b_hi, b_over_a = b_lo - of.a_hi;
      if (link.rule == ChoiceRule::Greatest) std::swap(a_over_b, b_over_a);
    }
    kept[j] = {!(a_over_b > link.width), !(b_over_a > link.width)};
  }
}

}  // namespace fathom::vm
#endif  // HWY_ONCE
