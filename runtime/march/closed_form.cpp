// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/march/closed_form.h"

#include <cstddef>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/march/closed_form.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using compiler::ClosedForm;
using FormLanes = hn::CappedTag<double, 8>;
using Value = hn::Vec<FormLanes>;
using Truth = hn::Mask<FormLanes>;

// Error of t and of places, relative to the largest number: float knows no more of the solid.
constexpr double kFormError = 4e-6;
// Cosine, squared, below which a ray barely touches a surface.
constexpr double kLeastCosine2 = 1e-4;

HWY_INLINE Value all(double value) { return hn::Set(FormLanes(), value); }

// The parts of rays in a solid: empty if begin > end.
struct Parts {
  Value begin, end;
  Truth grazes, misses;
};

HWY_INLINE void clip_parts(Parts& parts, Value begin, Value end) {
  parts.begin = hn::Max(parts.begin, begin);
  parts.end = hn::Min(parts.end, end);
}

// The parts between the planes at -half and half across one axis.
HWY_INLINE void cut_slab(Parts& parts, Value place, Value speed, Value half) {
  const Truth along = hn::Eq(speed, all(0));
  const Value aside = hn::Sub(hn::Abs(place), half);
  parts.misses = hn::Or(parts.misses, hn::And(along, hn::Gt(aside, all(0))));
  const Truth close = hn::Lt(hn::Abs(aside), hn::Mul(all(kFormError), hn::Max(all(1), half)));
  parts.grazes = hn::Or(parts.grazes, hn::And(along, close));
  const Value inverse = hn::Div(all(1), hn::IfThenElse(along, all(1), speed));
  const Value a = hn::Mul(hn::Sub(hn::Neg(half), place), inverse), b = hn::Mul(hn::Sub(half, place), inverse);
  clip_parts(parts, hn::IfThenElse(along, parts.begin, hn::Min(a, b)),
             hn::IfThenElse(along, parts.end, hn::Max(a, b)));
}

// The parts within a ball or a round cylinder: |p + t d|^2 < r^2.
HWY_INLINE void cut_round(Parts& parts, Value pp, Value pd, Value dd, Value radius) {
  const Value rr = hn::Mul(radius, radius), excess = hn::Sub(pp, rr);
  const Truth along = hn::Eq(dd, all(0));
  parts.misses = hn::Or(parts.misses, hn::And(along, hn::Gt(excess, all(0))));
  const Truth close = hn::Lt(hn::Abs(excess), hn::Mul(all(kFormError), hn::Max(all(1), rr)));
  parts.grazes = hn::Or(parts.grazes, hn::And(along, close));
  const Value square = hn::Sub(hn::Mul(pd, pd), hn::Mul(dd, excess));
  const Value least =
      hn::Add(hn::Mul(all(kLeastCosine2), hn::Mul(dd, rr)), hn::Mul(all(kFormError), hn::Mul(pd, pd)));
  parts.grazes = hn::Or(parts.grazes, hn::AndNot(along, hn::Lt(hn::Abs(square), least)));
  parts.misses = hn::Or(parts.misses, hn::AndNot(along, hn::Lt(square, all(0))));
  const Value root = hn::Sqrt(hn::Max(square, all(0))), inverse = hn::Div(all(1), hn::IfThenElse(along, all(1), dd));
  const Value a = hn::Mul(hn::Sub(hn::Neg(pd), root), inverse), b = hn::Mul(hn::Sub(root, pd), inverse);
  clip_parts(parts, hn::IfThenElse(along, parts.begin, a), hn::IfThenElse(along, parts.end, b));
}

// The parts below a plane that they do not leave again.
HWY_INLINE void cut_half_space(Parts& parts, Value height, Value speed, Value dd) {
  const Truth falls = hn::Lt(speed, all(0));
  const Value t = hn::Div(hn::Neg(height), hn::IfThenElse(falls, speed, all(-1)));
  parts.begin = hn::IfThenElse(falls, hn::Max(parts.begin, t), parts.begin);
  parts.misses = hn::Or(parts.misses, hn::AndNot(falls, hn::Gt(height, all(0))));
  parts.grazes = hn::Lt(hn::Mul(speed, speed), hn::Mul(all(kLeastCosine2), dd));
}

HWY_INLINE Value dot(const Value* a, const Value* b) {
  return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
}

// size(k): the solids' k-th size.
template <class Size>
HWY_INLINE Parts parts_within(ClosedForm::Shape shape, const Size& size, const Value* p, const Value* d) {
  constexpr double kNoEnd = std::numeric_limits<double>::infinity();
  Parts parts{all(-kNoEnd), all(kNoEnd), hn::Lt(all(0), all(0)), hn::Lt(all(0), all(0))};
  switch (shape) {
    case ClosedForm::Shape::Ball:
      cut_round(parts, dot(p, p), dot(p, d), dot(d, d), size(0));
      break;
    case ClosedForm::Shape::Box:
      for (int axis = 0; axis < 3; ++axis) cut_slab(parts, p[axis], d[axis], size(axis));
      break;
    case ClosedForm::Shape::Cylinder:
      cut_round(parts, hn::Add(hn::Mul(p[0], p[0]), hn::Mul(p[2], p[2])),
                hn::Add(hn::Mul(p[0], d[0]), hn::Mul(p[2], d[2])), hn::Add(hn::Mul(d[0], d[0]), hn::Mul(d[2], d[2])),
                size(0));
      cut_slab(parts, p[1], d[1], size(1));
      break;
    default: {
      const Value normal[3] = {size(0), size(1), size(2)};
      cut_half_space(parts, hn::Sub(dot(normal, p), size(3)), dot(normal, d), dot(d, d));
    }
  }
  return parts;
}

// Offsets within a form from its first number, in doubles.
constexpr std::size_t kTranslation =
                          (offsetof(ClosedForm, translation) - offsetof(ClosedForm, linear)) / sizeof(double),
                      kSize = (offsetof(ClosedForm, size) - offsetof(ClosedForm, linear)) / sizeof(double);
static_assert(sizeof(ClosedForm) % sizeof(double) == 0);

// number(k): the k-th number of the solids' forms.
template <class Number>
HWY_INLINE void find_register(ClosedForm::Shape shape, Entrances& rays, std::size_t i, const Number& number) {
  const FormLanes d;
  Value origin[3], direction[3], p[3], along[3];
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = hn::LoadU(d, rays.origin[axis] + i);
    direction[axis] = hn::LoadU(d, rays.direction[axis] + i);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Value row[3] = {number(axis), number(axis + 3), number(axis + 6)};
    p[axis] = hn::Add(dot(row, origin), number(kTranslation + axis));
    along[axis] = dot(row, direction);
  }
  const auto size = [&](int k) HWY_ATTR { return number(kSize + static_cast<std::size_t>(k)); };
  const Parts parts = parts_within(shape, size, p, along);
  const Truth endless = hn::Lt(parts.begin, all(-std::numeric_limits<double>::max()));
  Value largest = hn::Max(all(1), hn::IfThenElse(endless, all(0), hn::Abs(parts.begin)));
  for (const Value& coordinate : origin) largest = hn::Max(largest, hn::Abs(coordinate));
  const Value slack = hn::Mul(all(kFormError), largest), far = hn::Mul(all(4), slack);
  const Truth thin = hn::Lt(hn::Abs(hn::Sub(parts.end, parts.begin)), far);
  const Truth behind = hn::Lt(parts.end, hn::Neg(far)), within = hn::Lt(parts.begin, far);
  const Truth past = hn::Or(hn::Gt(parts.begin, parts.end), behind);
  const auto code = [](Meeting meeting) HWY_ATTR { return all(static_cast<double>(meeting)); };
  Value meeting = hn::IfThenElse(within, code(Meeting::Uncertain), code(Meeting::Enters));
  meeting = hn::IfThenElse(past, code(Meeting::Misses), meeting);
  meeting = hn::IfThenElse(thin, code(Meeting::Uncertain), meeting);
  meeting = hn::IfThenElse(parts.misses, code(Meeting::Misses), meeting);
  meeting = hn::IfThenElse(parts.grazes, code(Meeting::Uncertain), meeting);
  hn::StoreU(meeting, d, rays.meeting + i);
  hn::StoreU(parts.begin, d, rays.t + i);
  hn::StoreU(slack, d, rays.slack + i);
}

void find(const ClosedForm* forms, bool alike, Entrances& rays) {
  const FormLanes d;
  const hn::RebindToSigned<FormLanes> s;
  if (rays.count == 0) return;
  const double* const numbers = &forms->linear[0][0];
  const double* const first = numbers + rays.form[0];
  const ClosedForm::Shape shape =
      forms[static_cast<std::size_t>(rays.form[0]) * sizeof(double) / sizeof(ClosedForm)].shape;
  for (std::size_t i = 0; i < rays.count; i += hn::Lanes(d)) {
    if (alike) {
      find_register(shape, rays, i, [&](std::size_t k) HWY_ATTR { return all(first[k]); });
    } else {  // lanes past the last ray have the form of an earlier one
      const auto at = hn::LoadU(s, rays.form + i);
      find_register(shape, rays, i, [&](std::size_t k) HWY_ATTR { return hn::GatherIndex(d, numbers + k, at); });
    }
  }
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(find);

void find_entrances(const compiler::ClosedForm* forms, bool alike, Entrances& rays) {
  HWY_DYNAMIC_DISPATCH(find)(forms, alike, rays);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
