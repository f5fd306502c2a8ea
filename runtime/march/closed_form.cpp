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
using compiler::kMostForms;
using FormLanes = hn::CappedTag<double, 8>;
using Value = hn::Vec<FormLanes>;
using Truth = hn::Mask<FormLanes>;

// Error of t and of places, relative to the largest number: float knows no more of the solid.
constexpr double kFormError = 4e-6;
// Cosine, squared, below which a ray barely touches a surface.
constexpr double kLeastCosine2 = 1e-4;

HWY_INLINE Value all(double value) { return hn::Set(FormLanes(), value); }

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

// The parts of rays in a solid: empty if begin > end.
struct Parts {
  Value begin, end;
  Truth grazes, misses;
  Truth uncertain;  // where the part begins, which is not before `begin`
};

HWY_INLINE Parts whole_rays() {
  const Truth no = hn::Lt(all(0), all(0));
  return {all(-kNoEnd), all(kNoEnd), no, no, no};
}

HWY_INLINE void clip_parts(Parts& parts, Value begin, Value end) {
  parts.begin = hn::Max(parts.begin, begin);
  parts.end = hn::Min(parts.end, end);
}

// The inverse of a part of a direction, finite.
HWY_INLINE Value inverse_of(Value part) {
  const Value least = all(1e-30);
  return hn::Div(all(1), hn::IfThenElse(hn::Lt(hn::Abs(part), least), hn::CopySign(least, part), part));
}

// The parts between the planes at -half and half across one axis.
HWY_INLINE void cut_slab(Parts& parts, Value place, Value speed, Value inverse, Value half) {
  const Truth along = hn::Eq(speed, all(0));
  const Value aside = hn::Sub(hn::Abs(place), half);
  parts.misses = hn::Or(parts.misses, hn::And(along, hn::Gt(aside, all(0))));
  const Truth close = hn::Lt(hn::Abs(aside), hn::Mul(all(kFormError), hn::Max(all(1), half)));
  parts.grazes = hn::Or(parts.grazes, hn::And(along, close));
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

// The parts below a plane.
HWY_INLINE void cut_half_space(Parts& parts, Value height, Value speed, Value dd) {
  const Truth falls = hn::Lt(speed, all(0)), along = hn::Eq(speed, all(0));
  const Value t = hn::Div(hn::Neg(height), hn::IfThenElse(along, all(-1), speed));
  clip_parts(parts, hn::IfThenElse(falls, t, parts.begin), hn::IfThenElse(hn::Or(falls, along), parts.end, t));
  parts.misses = hn::Or(parts.misses, hn::AndNot(falls, hn::Gt(height, all(0))));
  parts.grazes = hn::Or(parts.grazes, hn::Lt(hn::Mul(speed, speed), hn::Mul(all(kLeastCosine2), dd)));
}

HWY_INLINE Value dot(const Value* a, const Value* b) {
  return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
}

// A register of rays in a solid's space. size(k): the solids' k-th size.
struct LocalRays {
  Value p[3], d[3];
  Value inverse[3];  // of d

  HWY_INLINE Value square(const Value* a) const { return hn::Add(hn::Mul(a[0], a[0]), hn::Mul(a[2], a[2])); }
  // |p + t d| < radius, about the point at height y.
  HWY_INLINE void cut_ball(Parts& parts, Value y, Value radius) const {
    const Value q[3] = {p[0], hn::Sub(p[1], y), p[2]};
    cut_round(parts, dot(q, q), dot(q, d), dot(d, d), radius);
  }
  HWY_INLINE void cut_slab_of(Parts& parts, int axis, Value half) const {
    cut_slab(parts, p[axis], d[axis], inverse[axis], half);
  }
  HWY_INLINE void cut_cylinder(Parts& parts, Value radius, Value half) const {
    cut_round(parts, square(p), hn::Add(hn::Mul(p[0], d[0]), hn::Mul(p[2], d[2])), square(d), radius);
    cut_slab_of(parts, 1, half);
  }
  // The convex hull of parts that overlap or are empty.
  HWY_INLINE static void join(Parts& all_parts, const Parts& more) {
    const Truth empty = hn::Or(more.misses, hn::Gt(more.begin, more.end));
    all_parts.begin = hn::Min(all_parts.begin, hn::IfThenElse(empty, all(kNoEnd), more.begin));
    all_parts.end = hn::Max(all_parts.end, hn::IfThenElse(empty, all(-kNoEnd), more.end));
    all_parts.grazes = hn::Or(all_parts.grazes, more.grazes);
    all_parts.misses = hn::And(all_parts.misses, empty);
  }
  HWY_INLINE void cut_capsule(Parts& parts, Value radius, Value half) const {
    Parts side = whole_rays(), low = side, high = side;
    cut_cylinder(side, radius, half);
    cut_ball(low, hn::Neg(half), radius);
    cut_ball(high, half, radius);
    parts.begin = all(kNoEnd), parts.end = all(-kNoEnd), parts.misses = hn::Le(all(0), all(0));
    for (const Parts& each : {side, low, high}) join(parts, each);
  }
  // Rays may pass a rounded edge that begin within `radius` of two faces, at depths below them.
  HWY_INLINE static void avoid_edges(Parts& parts, Value first, Value second, Value third, Value radius) {
    const Truth a = hn::Lt(first, radius), b = hn::Lt(second, radius), c = hn::Lt(third, radius);
    const Truth two = hn::Or(hn::And(a, b), hn::And(c, hn::Or(a, b)));
    parts.uncertain = hn::Or(parts.uncertain, hn::And(two, hn::Le(parts.begin, parts.end)));
  }
  HWY_INLINE Value depth(const Parts& parts, int axis, Value half) const {
    return hn::Sub(half, hn::Abs(hn::Add(p[axis], hn::Mul(parts.begin, d[axis]))));
  }

  template <class Size>
  HWY_INLINE Parts parts_within(ClosedForm::Shape shape, const Size& size) const {
    using Shape = ClosedForm::Shape;
    Parts parts = whole_rays();
    switch (shape) {
      case Shape::Ball:
        cut_ball(parts, all(0), size(0));
        break;
      case Shape::Box:
      case Shape::RoundBox:
        for (int axis = 0; axis < 3; ++axis) cut_slab_of(parts, axis, size(axis));
        if (shape == Shape::RoundBox)
          avoid_edges(parts, depth(parts, 0, size(0)), depth(parts, 1, size(1)), depth(parts, 2, size(2)), size(3));
        break;
      case Shape::Cylinder:
        cut_cylinder(parts, size(0), size(1));
        break;
      case Shape::RoundedCylinder: {
        cut_cylinder(parts, size(0), size(1));
        const Value x = hn::Add(p[0], hn::Mul(parts.begin, d[0])), z = hn::Add(p[2], hn::Mul(parts.begin, d[2]));
        const Value about = hn::Sub(size(0), hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(z, z))));
        avoid_edges(parts, about, depth(parts, 1, size(1)), all(kNoEnd), size(2));
        break;
      }
      case Shape::Capsule:
        cut_capsule(parts, size(0), size(1));
        break;
      case Shape::HalfSpace: {
        const Value normal[3] = {size(0), size(1), size(2)};
        cut_half_space(parts, hn::Sub(dot(normal, p), size(3)), dot(normal, d), dot(d, d));
      }
    }
    return parts;
  }
};

// Offsets within a form from its first number, in doubles.
constexpr std::size_t kTranslation =
                          (offsetof(ClosedForm, translation) - offsetof(ClosedForm, linear)) / sizeof(double),
                      kSize = (offsetof(ClosedForm, size) - offsetof(ClosedForm, linear)) / sizeof(double),
                      kForm = sizeof(ClosedForm) / sizeof(double);
static_assert(sizeof(ClosedForm) % sizeof(double) == 0);

// A register of rays and what all solids need of them.
struct WorldRays {
  Value origin[3], direction[3], inverse[3];
  Value largest;  // part of the origin, or 1

  template <class Rays>
  HWY_INLINE WorldRays(const Rays& rays, std::size_t i) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = hn::LoadU(FormLanes(), rays.origin[axis] + i);
      direction[axis] = hn::LoadU(FormLanes(), rays.direction[axis] + i);
      inverse[axis] = inverse_of(direction[axis]);
    }
    largest = hn::Max(hn::Max(all(1), hn::Abs(origin[0])), hn::Max(hn::Abs(origin[1]), hn::Abs(origin[2])));
  }
  // Bound on the error of t.
  HWY_INLINE Value slack(Value t) const {
    const Truth endless = hn::Gt(hn::Abs(t), all(std::numeric_limits<double>::max()));
    return hn::Mul(all(kFormError), hn::Max(largest, hn::IfThenElse(endless, all(0), hn::Abs(t))));
  }
  // number(k): the k-th number of the solids' forms. `moved`: they are not turned.
  template <class Number>
  HWY_INLINE LocalRays in_solid(const Number& number, bool moved) const {
    LocalRays local;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (moved) {
        local.p[axis] = hn::Add(origin[axis], number(kTranslation + axis));
        local.d[axis] = direction[axis], local.inverse[axis] = inverse[axis];
      } else {
        const Value row[3] = {number(axis), number(axis + 3), number(axis + 6)};
        local.p[axis] = hn::Add(dot(row, origin), number(kTranslation + axis));
        local.d[axis] = dot(row, direction);
        local.inverse[axis] = inverse_of(local.d[axis]);
      }
    }
    return local;
  }
};

// Entrances of a register of rays into pieces.
struct Entered {
  Value t, slack;
  Truth misses, enters;  // neither: uncertain
  Value earliest;        // no entrance before
};

// Moves `t` out of the parts that are cut away. `uncertain`: rounding decides. Rays begin outside of what is left.
HWY_INLINE void leave_cuts(const WorldRays& rays, const Parts* cuts, std::size_t count, Value& t, Truth& uncertain) {
  // A cut that begins so little before t may not hold it. At the ray's origin one does, and float tells it.
  Value least = hn::IfThenElse(hn::Le(t, all(0)), hn::Mul(all(1e-3), rays.slack(t)), hn::Mul(all(4), rays.slack(t)));
  for (std::size_t pass = 0; pass < count; ++pass) {
    for (std::size_t k = 0; k < count; ++k) {
      const Parts& cut = cuts[k];
      const Truth within = hn::AndNot(cut.misses, hn::And(hn::Lt(cut.begin, t), hn::Lt(t, cut.end)));
      uncertain = hn::Or(uncertain, hn::And(within, hn::Lt(hn::Sub(t, cut.begin), least)));
      t = hn::IfThenElse(within, cut.end, t);
      least = hn::IfThenElse(within, hn::Mul(all(4), rays.slack(t)), least);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Truth close = hn::Lt(hn::Abs(hn::Sub(cuts[k].begin, t)), hn::Mul(all(4), rays.slack(t)));
    uncertain = hn::Or(uncertain, hn::AndNot(cuts[k].misses, hn::Or(close, cuts[k].grazes)));
  }
}

// part(k): the parts of the rays in the k-th of `forms`.
template <class Part>
HWY_INLINE Entered enter(std::span<const ClosedForm> forms, const WorldRays& rays, const Part& part) {
  Parts parts = whole_rays();
  Parts cuts[kMostForms];
  std::size_t cut = 0;
  for (std::size_t k = 0; k < forms.size(); ++k) {
    const Parts own = part(k);
    if (forms[k].cut) {
      cuts[cut++] = own;
    } else if (k == 0) {
      parts = own;
    } else {
      clip_parts(parts, own.begin, own.end);
      parts.misses = hn::Or(parts.misses, own.misses);
      parts.grazes = hn::Or(parts.grazes, own.grazes);
    }
  }
  Value far = hn::Mul(all(4), rays.slack(parts.begin));
  const Value earliest = hn::IfThenElse(parts.grazes, all(0), hn::Max(all(0), hn::Sub(parts.begin, far)));
  Truth uncertain = hn::Or(parts.grazes, parts.uncertain);
  Value t = parts.begin;
  Truth past = hn::Gt(parts.begin, parts.end);
  if (cut > 0) {
    past = hn::Or(past, hn::Lt(parts.end, hn::Neg(far)));
    t = hn::Max(t, all(0));
    Truth unsure = hn::Lt(all(0), all(0));
    leave_cuts(rays, cuts, cut, t, unsure);
    uncertain = hn::Or(uncertain, unsure);
    far = hn::Mul(all(4), rays.slack(t));
    past = hn::Or(past, hn::AndNot(unsure, hn::Gt(t, parts.end)));
  }
  const Truth thin = hn::Lt(hn::Abs(hn::Sub(parts.end, t)), far);
  past = hn::AndNot(thin, hn::Or(past, hn::Lt(parts.end, hn::Neg(far))));
  const Truth misses = hn::AndNot(parts.grazes, hn::Or(parts.misses, past));
  uncertain = hn::Or(hn::Or(uncertain, thin), hn::Lt(t, far));
  return {t, rays.slack(t), misses, hn::AndNot(uncertain, hn::Not(misses)), earliest};
}

// number(k, n): the n-th number of the k-th form.
template <class Number>
HWY_INLINE void find_register(std::span<const ClosedForm> forms, Entrances& rays, std::size_t i,
                              const Number& number) {
  const FormLanes d;
  const WorldRays world(rays, i);
  const Entered entered = enter(forms, world, [&](std::size_t k) HWY_ATTR {
    const LocalRays local = world.in_solid([&](std::size_t n) HWY_ATTR { return number(k, n); }, false);
    return local.parts_within(forms[k].shape,
                              [&](int n) HWY_ATTR { return number(k, kSize + static_cast<std::size_t>(n)); });
  });
  const auto code = [](Meeting meeting) HWY_ATTR { return all(static_cast<double>(meeting)); };
  const Value meeting = hn::IfThenElse(entered.enters, code(Meeting::Enters), code(Meeting::Uncertain));
  hn::StoreU(hn::IfThenElse(entered.misses, code(Meeting::Misses), meeting), d, rays.meeting + i);
  hn::StoreU(entered.t, d, rays.t + i);
  hn::StoreU(entered.slack, d, rays.slack + i);
}

void find(std::span<const ClosedForm> all_forms, std::size_t count, bool alike, Entrances& rays) {
  const FormLanes d;
  const hn::RebindToSigned<FormLanes> s;
  if (rays.count == 0) return;
  const double* const numbers = &all_forms[0].linear[0][0];
  const double* const first = numbers + rays.form[0];
  const auto forms = all_forms.subspan(static_cast<std::size_t>(rays.form[0]) / kForm, count);
  for (std::size_t i = 0; i < rays.count; i += hn::Lanes(d)) {
    if (alike) {
      find_register(forms, rays, i, [&](std::size_t k, std::size_t n) HWY_ATTR { return all(first[k * kForm + n]); });
    } else {  // lanes past the last ray have the form of an earlier one
      const auto at = hn::LoadU(s, rays.form + i);
      find_register(forms, rays, i, [&](std::size_t k, std::size_t n) HWY_ATTR {
        return hn::GatherIndex(d, numbers + k * kForm + n, at);
      });
    }
  }
}

// Distances at which rays enter a box, infinite if they pass it.
HWY_INLINE Value enter_box(const compiler::Box& box, const Value* origin, const Value* inverse) {
  Value begin = all(0), end = all(std::numeric_limits<double>::infinity());
  for (int axis = 0; axis < 3; ++axis) {
    const Value a = hn::Mul(hn::Sub(all(box.lo[axis]), origin[axis]), inverse[axis]),
                b = hn::Mul(hn::Sub(all(box.hi[axis]), origin[axis]), inverse[axis]);
    begin = hn::Max(begin, hn::Min(a, b));
    end = hn::Min(end, hn::Max(a, b));
  }
  return hn::IfThenElse(hn::Le(begin, end), begin, all(std::numeric_limits<double>::infinity()));
}

HWY_INLINE Entered enter_piece(const ScannedPiece& scanned, const WorldRays& world) {
  return enter(scanned.forms, world, [&](std::size_t form) HWY_ATTR {
    const double* const numbers = &scanned.forms[form].linear[0][0];
    const auto number = [&](std::size_t n) HWY_ATTR { return all(numbers[n]); };
    const LocalRays local = world.in_solid(number, scanned.moved);
    return local.parts_within(scanned.forms[form].shape,
                              [&](int n) HWY_ATTR { return number(kSize + static_cast<std::size_t>(n)); });
  });
}

void find_first_of(std::span<const ScannedPiece> pieces, const RayBlock& rays, std::size_t i, FirstMet& met) {
  const FormLanes d;
  const hn::Rebind<std::uint32_t, FormLanes> half;
  const hn::RebindToUnsigned<FormLanes> whole;
  const Value none = all(kNoEnd);
  const WorldRays world(rays, i);
  const auto leaves = hn::PromoteTo(whole, hn::LoadU(half, rays.leaves + i));
  const Value length = hn::Min(hn::LoadU(d, rays.length + i), all(1e300));
  Value t = none, slack = all(0), piece = all(FirstMet::kNone);
  Value last = length;        // no entrance beyond matters
  Value edges[kMostScanned];  // where the pieces are entered at the earliest
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const ScannedPiece& scanned = pieces[k];
    edges[k] = enter_box(scanned.box, world.origin, world.inverse);
    if (scanned.convex)
      edges[k] = hn::IfThenElse(hn::RebindMask(d, hn::Eq(leaves, hn::Set(whole, scanned.number))), none, edges[k]);
    const Truth met_box = hn::Le(edges[k], last);
    if (scanned.forms.empty() || hn::AllFalse(d, met_box)) continue;
    const Entered entered = enter_piece(scanned, world);
    const Truth misses = hn::Or(hn::Not(met_box), entered.misses), enters = hn::And(met_box, entered.enters);
    edges[k] =
        hn::IfThenElse(misses, none, hn::IfThenElse(enters, hn::Sub(entered.t, entered.slack), entered.earliest));
    const Truth nearer = hn::And(enters, hn::Lt(entered.t, t));
    t = hn::IfThenElse(nearer, entered.t, t);
    slack = hn::IfThenElse(nearer, entered.slack, slack);
    piece = hn::IfThenElse(nearer, all(static_cast<double>(scanned.number)), piece);
    last = hn::Min(length, hn::Add(t, hn::Add(slack, slack)));
  }
  piece = hn::IfThenElse(hn::Gt(hn::Sub(t, slack), length), all(FirstMet::kNone), piece);
  auto others = hn::Zero(whole);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const std::uint32_t number = pieces[k].number;
    const Truth meets = hn::AndNot(hn::Eq(piece, all(static_cast<double>(number))), hn::Le(edges[k], last));
    others =
        hn::Or(others, hn::IfThenElseZero(hn::RebindMask(whole, meets), hn::Set(whole, std::uint64_t{1} << number)));
  }
  hn::StoreU(piece, d, met.piece + i);
  hn::StoreU(t, d, met.t + i);
  hn::StoreU(slack, d, met.slack + i);
  hn::StoreU(others, whole, met.others + i);
}

void find_all_first(std::span<const ScannedPiece> pieces, const RayBlock& rays, std::size_t first, FirstMet& met) {
  for (std::size_t i = first; i < rays.count; i += hn::Lanes(FormLanes())) find_first_of(pieces, rays, i, met);
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(find);
HWY_EXPORT(find_all_first);

void find_entrances(std::span<const compiler::ClosedForm> forms, std::size_t count, bool alike, Entrances& rays) {
  HWY_DYNAMIC_DISPATCH(find)(forms, count, alike, rays);
}

void find_first(std::span<const ScannedPiece> pieces, const RayBlock& rays, std::size_t first, FirstMet& met) {
  HWY_DYNAMIC_DISPATCH(find_all_first)(pieces, rays, first, met);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
