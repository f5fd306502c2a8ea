// The interpreter over boxes, Machine<FloatInterval>: opcode functions with a separate form for FloatInterval, the
// entries of the point stack, and the observer of choices.
#if defined(FATHOM_VM_ENCLOSED_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_ENCLOSED_INL
#undef FATHOM_VM_ENCLOSED_INL
#else
#define FATHOM_VM_ENCLOSED_INL
#endif

#include "vm/interpret/interpret-inl.h"
#include "vm/number/float_interval_elementary-inl.h"
#include "vm/program/opcode_rows.h"
#include "vm/range/choice_bounds.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Maximum distance from the origin, in scene units, at which a ball's bounds are used. Further out, squares may
// overflow and angles are unknown.
inline constexpr float kBallReach = 1e12f;

// A range of several cells gives all of 0..288, widened by one for float errors. Beyond 2^20 the result is unknown.
HWY_INLINE FloatInterval permute(const FloatInterval& n) {
  const Batch one_cell = permute(n.lo);
  const BatchMask known = magnitude(sizes(n)) < Batch::broadcast(0x1p20f), one = n.lo == n.hi;
  return whole_where(
      !known, {select(one, one_cell, Batch::broadcast(-1.0f)), select(one, one_cell, Batch::broadcast(290.0f))});
}

// Range of a smooth minimum or maximum `at` of width k. Both are nondecreasing in both operands if 2 k inv4k is at
// most 1, so the operands' ends give the range; the generic formula would use each operand several times. Rounding
// errs by less than 2^-22 of result and width, twice.
template <class Blend>
HWY_INLINE FloatInterval blend(const FloatInterval& a, const FloatInterval& b, Batch k, const Blend& at) {
  const auto slack = [&](Batch end) HWY_ATTR { return (abs(end) + k) * Batch::broadcast(0x1p-21f); };
  const Batch lo = at(a.lo, b.lo), hi = at(a.hi, b.hi);
  return whole_where(!(is_bounded(a) & is_bounded(b)), without_nan(lo - slack(lo), hi + slack(hi)));
}
HWY_INLINE FloatInterval smooth_min(const FloatInterval& a, const FloatInterval& b, Batch k, Batch inv4k) {
  return blend(a, b, k, [&](Batch x, Batch y) HWY_ATTR { return smooth_min(x, y, k, inv4k); });
}
HWY_INLINE FloatInterval smooth_max(const FloatInterval& a, const FloatInterval& b, Batch k, Batch inv4k) {
  return blend(a, b, k, [&](Batch x, Batch y) HWY_ATTR { return smooth_max(x, y, k, inv4k); });
}

// As for Interval: the values at the nearest and the farthest corner, each with its rounding error.
HWY_INLINE FloatInterval ellipse(const Vec3<FloatInterval>& p, const Batch* k) {
  const FloatInterval x = abs(p.x), y = abs(p.y);
  const Batch reach = max(Batch::broadcast(1.0f), x.hi + y.hi + k[0]);
  const Batch slack = reach * Batch::broadcast(4 * kFloatError);
  const Batch lo = ellipse(Vec3<Batch>{x.lo, y.lo, x.lo}, k), hi = ellipse(Vec3<Batch>{x.hi, y.hi, x.hi}, k);
  return whole_where(!(reach < Batch::broadcast(kBallReach)), {lo - slack, hi + slack});
}

// A ball that contains all f32 points to which the program can map the box's points.
struct Ball {
  Vec3<Batch> centre;
  Batch radius;
};
HWY_INLINE Batch taxicab(const Vec3<Batch>& p) { return abs(p.x) + abs(p.y) + abs(p.z); }
// Returns the smallest ball around a box. The radius is NaN or infinite for an unbounded box, and never so small that
// squares which vanish in float could matter.
HWY_INLINE Ball ball_around(const Vec3<FloatInterval>& box) {
  const Batch half = Batch::broadcast(0.5f);
  const auto middle = [&](const FloatInterval& a) HWY_ATTR { return a.lo * half + a.hi * half; };
  const auto reach = [](const FloatInterval& a, Batch from) HWY_ATTR { return max(a.hi - from, from - a.lo); };
  const Vec3<Batch> c{middle(box.x), middle(box.y), middle(box.z)};
  const Batch diagonal = length(reach(box.x, c.x), reach(box.y, c.y), reach(box.z, c.z));
  return {c, diagonal * Batch::broadcast(1 + 0x1p-20f) + Batch::broadcast(0x1p-59f)};
}
HWY_INLINE Ball smaller(const Ball& a, const Ball& b) {
  const BatchMask first = a.radius <= b.radius;
  const auto pick = [&](Batch x, Batch y) HWY_ATTR { return select(first, x, y); };
  return {{pick(a.centre.x, b.centre.x), pick(a.centre.y, b.centre.y), pick(a.centre.z, b.centre.z)},
          pick(a.radius, b.radius)};
}

// Range of noise: the value in the middle of the box, plus or minus the maximum change within the box and the
// rounding errors of both values.
HWY_INLINE FloatInterval noise(const FloatInterval& x, const FloatInterval& y, const FloatInterval& z) {
  const Ball ball = ball_around({x, y, z});
  const Batch error = Batch::broadcast(0x1p-18), most = Batch::broadcast(kNoiseRange) + error;
  static_assert(2 * kNoiseUnits * 0x1p-24 < 0x1p-18 - 0x1p-20);  // 2^-20 is for the rounding errors here
  const Batch value = noise(ball.centre.x, ball.centre.y, ball.centre.z);
  const Batch spread = ball.radius * Batch::broadcast(kNoiseSlope * (1 + 0x1p-20)) + error;
  // For an unbounded box the radius may be NaN; max and min then return their second operand, the general bound.
  return whole_where(is_whole(x) | is_whole(y) | is_whole(z),
                     {max(value - spread, -most), min(value + spread, most)});
}

// Bounds of an affine map M. most: bound on the largest singular value, the root of the largest row sum of |M^T M|
// (Gershgorin), which is 1 for a rotation. terms: bound on the size of the products of a row, the root of the sum of
// squares of M.
struct OperatorNorm {
  double most, terms;
};
HWY_INLINE OperatorNorm operator_norm(const Batch* k) {
  double m[12];
  for (int i = 0; i < 12; ++i) m[i] = hn::GetLane(k[i].v);
  double most = 0, trace = 0;
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) sum += std::fabs(m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j]);
    most = std::max(most, sum);
    trace += m[i] * m[i] + m[4 + i] * m[4 + i] + m[8 + i] * m[8 + i];
  }
  return {std::sqrt(most), std::sqrt(trace)};
}

// Returns the range of a 1-Lipschitz shape over the ball about `centre`, from its value there. Rounding errs, at the
// centre and at the point, by the bound of vm/program/opcodes.def, where `size` is the size of features far from the
// origin, and by 2^-24 of the point for a moved shape. Together these are 22 units of 2^-24; 32 are used.
HWY_INLINE FloatInterval around(const Vec3<Batch>& centre, Batch radius, Batch value, Batch size, BatchMask& known) {
  const Batch reach = max(Batch::broadcast(1.0f), max(taxicab(centre), abs(value))) + (size + radius);
  const Batch slack = radius + reach * Batch::broadcast(0x1p-19f);
  known = reach < Batch::broadcast(kBallReach);
  return {value - slack, value + slack};
}

// An entry of the point stack is a box and a ball, both of which contain the point.
template <>
struct PointTraits<FloatInterval> {
  struct Place : Vec3<FloatInterval> {
    Ball ball;
  };
  static HWY_INLINE Place place(const Vec3<FloatInterval>& box) { return {box, ball_around(box)}; }

  template <class Op>
  static HWY_INLINE Place map(const Place& p, const Batch* k) {
    const Vec3<FloatInterval> box = Op::apply(p, k);
    if constexpr (Op::kOpcode == Opcode::Translate) {
      return {box, image<Op>(p.ball, k)};
    } else if constexpr (has(Op::kOpcode, Fact::Affine) || !has(Op::kOpcode, Fact::Expansive)) {
      return {box, smaller(image<Op>(p.ball, k), ball_around(box))};
    } else {
      return place(box);
    }
  }

  template <class Op, int Count>
  static HWY_INLINE FloatInterval shape(const Place& p, bool, const Batch* by, const Batch* k,
                                        const std::uint32_t* w) {
    if constexpr (!has(Op::kOpcode, Fact::Ball)) {
      return formula<Op>(p, by, k, w);
    } else {
      static_assert(!has(Op::kOpcode, Fact::Expansive));
      Batch size = Batch::broadcast(0.0f);
      if constexpr (has(Op::kOpcode, Fact::Far)) {
        constexpr int kSizes = has(Op::kOpcode, Fact::LastIsFlag) ? Count - 1 : Count;
        for (int i = 0; i < kSizes; ++i) size = max(size, abs(k[i]));
      }
      const Vec3<Batch> centre = TranslateOp::apply(p.ball.centre, by);
      BatchMask known;
      const FloatInterval value = around(centre, p.ball.radius, Op::apply(centre, k, w), size, known);
      if constexpr (has(Op::kOpcode, Fact::Formula)) {
        const FloatInterval range = formula<Op>(p, by, k, w);
        return select(known, FloatInterval{max(value.lo, range.lo), min(value.hi, range.hi)}, range);
      }
      if (!any(!known)) return value;
      return select(known, value, formula_apart<Op>(p, by, k, w));
    }
  }
  template <class Op>
  static HWY_INLINE FloatInterval formula(const Vec3<FloatInterval>& box, const Batch* by, const Batch* k,
                                          const std::uint32_t* w) {
    return Op::apply(TranslateOp::apply(box, by), k, w);
  }
  // formula() as a function of its own, for the few boxes that are unbounded or beyond kBallReach.
  template <class Op>
  static HWY_NOINLINE FloatInterval formula_apart(const Vec3<FloatInterval>& box, const Batch* by, const Batch* k,
                                                  const std::uint32_t* w) {
    return formula<Op>(box, by, k, w);
  }

  template <class Op, class Groups>
  static HWY_INLINE FloatInterval outline(const Place& p, const Groups& groups) {
    static_assert(has(Op::kOpcode, Fact::Ball) && has(Op::kOpcode, Fact::Far) && !has(Op::kOpcode, Fact::Expansive));
    double size = 0;
    for (std::size_t i = 0; i < groups.count(); ++i) {
      size = std::max(size, std::fabs(groups(i, 0)) + std::fabs(groups(i, 1)));
    }
    BatchMask known;
    const Batch middle = Op::apply(p.ball.centre, groups);
    const FloatInterval value = around(p.ball.centre, p.ball.radius, middle, Batch::broadcast(size), known);
    return whole_where(!known, value);
  }

 private:
  // Returns the image of a ball under a nonexpansive or affine map. f32 errs by a few units of 2^-24 of the map's
  // terms, the largest of which is at most the sum of the sizes of operand and result.
  template <class Op>
  static HWY_INLINE Ball image(const Ball& ball, const Batch* k) {
    constexpr bool kTranslate = Op::kOpcode == Opcode::Translate;
    OperatorNorm stretch{1, kTranslate ? 0 : 1};
    if constexpr (Op::kOpcode == Opcode::Affine) stretch = operator_norm(k);
    const Vec3<Batch> centre = Op::apply(ball.centre, k);
    const Batch radius = ball.radius * Batch::broadcast(stretch.most * (1 + 0x1p-20));
    const Batch terms = (taxicab(ball.centre) + ball.radius) * Batch::broadcast(stretch.terms * (1 + 0x1p-20));
    const Batch slack = (terms + taxicab(centre) + radius) * Batch::broadcast(kTranslate ? 0x1p-21f : 0x1p-17f);
    return {centre, radius + slack};
  }
};

// One slot holds all boxes of a call of enclose().
template <>
inline constexpr std::size_t kSlot<FloatInterval> = kEnclosedBoxes / kLanes;
template <>
inline constexpr bool kAlwaysFull<FloatInterval> = true;

template <>
struct ChoiceObserver<FloatInterval> {
  ChoiceBounds* bounds = nullptr;

  HWY_INLINE void see(std::size_t i, const FloatInterval& a, const FloatInterval& b) {
    const std::size_t at = i * kLanes;
    a.lo.store(bounds->a_lo + at), a.hi.store(bounds->a_hi + at);
    b.lo.store(bounds->b_lo + at), b.hi.store(bounds->b_hi + at);
  }
  HWY_INLINE void next() { ++bounds; }
};

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
