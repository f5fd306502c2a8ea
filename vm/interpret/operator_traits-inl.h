// The opcodes' definitions as functions, and their application to the interpreter's values and points.
#if defined(FATHOM_VM_OPERATOR_TRAITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_OPERATOR_TRAITS_INL
#undef FATHOM_VM_OPERATOR_TRAITS_INL
#else
#define FATHOM_VM_OPERATOR_TRAITS_INL
#endif

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "vm/interpret/domain-inl.h"
#include "vm/interpret/operators-inl.h"
#include "vm/interpret/outlines-inl.h"
#include "vm/interpret/solids-inl.h"
#include "vm/program/opcode.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

#define OP(Name, mnemonic, form, immediates, choice, ...) inline constexpr Choice kChoice##Name = Choice::choice;
#include "vm/program/opcodes.def"
#undef OP

// One struct per opcode with its definition as a function. The form determines the parameters.
#define OP_Point(Name, meaning)                                                                \
  struct Name##Op {                                                                            \
    static constexpr Opcode kOpcode = Opcode::Name;                                            \
    template <class T>                                                                         \
    static HWY_INLINE Vec3<T> apply(const Vec3<T>& p, [[maybe_unused]] const Constant<T>* k) { \
      return meaning;                                                                          \
    }                                                                                          \
  };
#define OP_Shape(Name, meaning)                                                        \
  struct Name##Op {                                                                    \
    static constexpr Opcode kOpcode = Opcode::Name;                                    \
    template <class T>                                                                 \
    static HWY_INLINE T apply(const Vec3<T>& p, [[maybe_unused]] const Constant<T>* k, \
                              [[maybe_unused]] const std::uint32_t* w) {               \
      return meaning;                                                                  \
    }                                                                                  \
  };
#define OP_Outline(Name, meaning)                                        \
  struct Name##Op {                                                      \
    static constexpr Opcode kOpcode = Opcode::Name;                      \
    template <class T, class Groups>                                     \
    static HWY_INLINE T apply(const Vec3<T>& p, const Groups& outline) { \
      return meaning;                                                    \
    }                                                                    \
  };
#define OP_Unary(Name, meaning)                                                    \
  struct Name##Op {                                                                \
    template <class T>                                                             \
    static HWY_INLINE T apply(const T& a, [[maybe_unused]] const Constant<T>* k) { \
      return meaning;                                                              \
    }                                                                              \
  };
#define OP_Binary(Name, meaning)                                                               \
  struct Name##Op {                                                                            \
    static constexpr Choice kChoice = kChoice##Name;                                           \
    template <class T>                                                                         \
    static HWY_INLINE T apply(const T& a, const T& b, [[maybe_unused]] const Constant<T>* k) { \
      return meaning;                                                                          \
    }                                                                                          \
  };
#define OP_Ternary(Name, meaning)                                   \
  struct Name##Op {                                                 \
    template <class T>                                              \
    static HWY_INLINE T apply(const T& a, const T& b, const T& c) { \
      return meaning;                                               \
    }                                                               \
  };
#define OP_Machine(Name, meaning)
#define OP(Name, mnemonic, form, immediates, choice, cost, facts, meaning) OP_##form(Name, (meaning))
#include "vm/program/opcodes.def"
#include "vm/program/opcodes_end.def"

// Traits of a value type T. Point: number type of the points that shapes run on, without Tagged and Convex. lift():
// converts a shape's result to a value; `convex` is true for a convex shape. apply(): applies an opcode to values.
template <class T>
struct ValueTraits {
  using Point = T;
  static constexpr bool kConvex = false;
  static HWY_INLINE T lift(const Point& value, bool = false) { return value; }
  template <class Op>
  static HWY_INLINE T apply(const T& a, const Constant<T>* k) {
    return Op::apply(a, k);
  }
  template <class Op>
  static HWY_INLINE T apply(const T& a, const T& b, const Constant<T>* k) {
    return Op::apply(a, b, k);
  }
  template <class Op>
  static HWY_INLINE T apply(const T& a, const T& b, const T& c) {
    return Op::apply(a, b, c);
  }
  static HWY_INLINE void tag(T&, std::uint32_t) {}
};
template <class T>
struct ValueTraits<Convex<T>> {
  using Point = T;
  static constexpr bool kConvex = true;
  static HWY_INLINE Convex<T> lift(const T& value, bool convex = false) {
    if (convex) return {value, constant<T>(std::numeric_limits<double>::infinity())};
    return plain(value);
  }
  template <class Op>
  static HWY_INLINE Convex<T> apply(const Convex<T>& a, const Constant<T>* k) {
    Convex<T> result = plain(Op::apply(a.v, k));
    if constexpr (std::is_same_v<Op, ScaleOp>) result.convex = max(a.convex * k[0], result.convex);
    if constexpr (std::is_same_v<Op, OffsetOp>) {
      // Shrinking a solid exposes its interior, where the operand's radius says nothing.
      result.convex = select(k[0] < constant<T>(0.0), result.convex, max(a.convex - k[0], result.convex));
    }
    return result;
  }
  template <class Op>
  static HWY_INLINE Convex<T> apply(const Convex<T>& a, const Convex<T>& b, const Constant<T>* k) {
    if constexpr (Op::kChoice != Choice::None) return Op::apply(a, b, k);
    Convex<T> result = plain(Op::apply(a.v, b.v, k));
    if constexpr (std::is_same_v<Op, MeetOp>) result.convex = max(convex_intersection(a, b), result.convex);
    return result;
  }
  template <class Op>
  static HWY_INLINE Convex<T> apply(const Convex<T>& a, const Convex<T>& b, const Convex<T>& c) {
    return plain(Op::apply(a.v, b.v, c.v));
  }
  static HWY_INLINE void tag(Convex<T>&, std::uint32_t) {}
};
// A shape's value belongs to no surface (kNoSurface) until a tag assigns one; a tag leaves values that have a surface
// unchanged. Operations other than choices act on the number alone and keep the (left) operand's surface.
inline constexpr double kNoSurface = -1;
template <class T>
struct ValueTraits<Tagged<T>> {
  using Number = ValueTraits<T>;
  using Point = typename Number::Point;
  static constexpr bool kConvex = Number::kConvex;
  static HWY_INLINE Tagged<T> lift(const Point& value, bool convex = false) {
    return {Number::lift(value, convex), constant<T>(kNoSurface)};
  }
  template <class Op>
  static HWY_INLINE Tagged<T> apply(const Tagged<T>& a, const Constant<T>* k) {
    return {Number::template apply<Op>(a.v, k), a.surface};
  }
  template <class Op>
  static HWY_INLINE Tagged<T> apply(const Tagged<T>& a, const Tagged<T>& b, const Constant<T>* k) {
    if constexpr (Op::kChoice != Choice::None) return Op::apply(a, b, k);
    return {Number::template apply<Op>(a.v, b.v, k), a.surface};
  }
  template <class Op>
  static HWY_INLINE Tagged<T> apply(const Tagged<T>& a, const Tagged<T>& b, const Tagged<T>& c) {
    return {Number::template apply<Op>(a.v, b.v, c.v), a.surface};
  }
  static HWY_INLINE void tag(Tagged<T>& value, double surface) {
    value.surface = select(value.surface < constant<T>(0.0), constant<T>(surface), value.surface);
  }
};

// Traits of the point stack for numbers of type P: the type of its entries, and the application of Point, Shape and
// Outline opcodes to them. `by`: the translation of a shape, 0 for a shape that is not `moved`.
template <class P>
struct PointTraits {
  using Place = Vec3<P>;
  template <class Op>
  static HWY_INLINE Place map(const Place& p, const Constant<P>* k) {
    return Op::apply(p, k);
  }
  template <class Op, int Count>
  static HWY_INLINE P shape(const Place& p, bool moved, const Constant<P>* by, const Constant<P>* k,
                            const std::uint32_t* w) {
    return Op::apply(moved ? TranslateOp::apply(p, by) : p, k, w);
  }
  template <class Op, class Groups>
  static HWY_INLINE P outline(const Place& p, const Groups& groups) {
    return Op::apply(p, groups);
  }
};

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
