// The interpreter: one loop, a template over the number type.
//
// A stack slot is a block of `kSlot<T>` numbers, so that one dispatch serves many points (256 with 16 f32 lanes). All
// slots of both stacks and the locals lie in one workspace and stay in the first-level cache. The interpreter checks
// nothing, because the program is verified.
#if defined(FATHOM_VM_INTERPRET_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_INTERPRET_INL
#undef FATHOM_VM_INTERPRET_INL
#else
#define FATHOM_VM_INTERPRET_INL
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "vm/interpret/operator_traits-inl.h"
#include "vm/interpret/workspace.h"
#include "vm/program/opcode_rows.h"
#include "vm/program/verify.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Observes the operands of each choice instruction: see() gets the i-th numbers of both operands, next() ends the
// choice. The primary template ignores them.
template <class T>
struct ChoiceObserver {
  HWY_INLINE void see(std::size_t, const T&, const T&) {}
  HWY_INLINE void next() {}
};

// Maps an executed tag to the number that its value gets. The primary template returns the instruction's surface and
// ignores the top point.
template <class T>
struct TagObserver {
  template <class Place>
  HWY_INLINE std::uint32_t see(std::uint32_t surface, const Place&) {
    return surface;
  }
};

// Numbers per stack slot. Sixteen registers per block measured best or equal: with fewer, an instruction waits for
// the previous one; with more, the cache is too small. Types that are many registers wide have shorter blocks.
template <class T>
inline constexpr std::size_t kSlot = 1;
template <>
inline constexpr std::size_t kSlot<Batch> = 16;
template <>
inline constexpr std::size_t kSlot<RealBatch> = 8;
template <>
inline constexpr std::size_t kSlot<Convex<Batch>> = 16;
template <>
inline constexpr std::size_t kSlot<Tagged<Convex<Dual<Batch>>>> = 4;

// True if the code of every opcode is inlined into the loop. A call per instruction costs measurable time only for
// types of one register. For all other types the opcodes are functions, and the loop compiles in half of the time.
template <class T>
inline constexpr bool kInLoop = HWY_TARGET != HWY_SCALAR && std::is_same_v<T, Batch>;
template <>
inline constexpr bool kInLoop<Real> = true;
template <>
inline constexpr bool kInLoop<RealBatch> = true;

// True if all numbers of a slot are always in use.
template <class T>
inline constexpr bool kAlwaysFull = kSlot<T> == 1;

HWY_INLINE Batch immediate(const Code& program, std::size_t word, Batch*) {
  return Batch::broadcast(std::bit_cast<float>(program.words[word]));
}
template <class C>
HWY_INLINE C immediate(const Code& program, std::size_t word, C*) {
  return C::broadcast(program.doubles[word]);
}

// Loads the constants in row `row` of a table [immediate][lane] whose rows are `stride` apart.
template <class C>
HWY_INLINE C constant_at(const float* table, std::size_t row, std::size_t stride, C*) {
  return C::load(table + row * stride);
}

// Groups of immediates of an Outline instruction; the first is at `word`. Immediates are converted to constants on
// access, because the number of groups has no bound.
template <class C, int kSize>
class Outline {
 public:
  Outline(const Code& program, std::size_t word, std::size_t count) : Outline(program.doubles + word, count) {}
  Outline(const double* doubles, std::size_t count) : wide_(doubles), count_(count) {}

  std::size_t count() const { return count_; }
  // Returns immediate j of group i, unrounded. The immediate's f32 word is this value rounded to f32
  // (vm/program/verify.h), as broadcast() rounds too.
  double operator()(std::size_t i, std::size_t j) const { return wide_[i * kSize + j]; }
  Outline<Real, kSize> real() const { return Outline<Real, kSize>(wide_, count_); }
  HWY_INLINE C constant(std::size_t i, std::size_t j) const { return C::broadcast((*this)(i, j)); }

 private:
  const double* wide_;
  std::size_t count_;
};

// Source of float immediates: the program, with the same value for all lanes, or a table [immediate][lane], in which
// each instruction's immediates begin at a multiple of four, and the program has none (vm/prune/program_template.h).
enum class Immediate { Program, PerLane };

template <class T, Immediate kFrom = Immediate::Program>
class Interpreter {
 public:
  using Traits = ValueTraits<T>;
  using P = typename Traits::Point;
  using Places = PointTraits<P>;
  using Place = typename Places::Place;
  using C = Constant<T>;
  static constexpr std::size_t kBlock = kFrom == Immediate::PerLane ? 1 : kSlot<T>;
  static constexpr std::size_t kSpares = 2;  // slots for operands that are neither on the stack nor in a local

  // `used`: number of numbers in use per slot. `table_bytes`: size of the table of immediates.
  Interpreter(const Code& program, Workspace& workspace, std::size_t used, std::size_t table_bytes = 0)
      : program_(program), used_(used) {
    const std::size_t point_bytes = program_.max_points * kBlock * sizeof(Place);
    const std::size_t value_slots = program_.max_values + program_.locals + kSpares;
    const std::size_t value_bytes = value_slots * kBlock * sizeof(T);
    auto* memory = static_cast<std::byte*>(workspace.reserve(point_bytes + value_bytes + table_bytes));
    points_ = reinterpret_cast<Place*>(memory);
    values_ = reinterpret_cast<T*>(memory + point_bytes);
    locals_ = values_ + program_.max_values * kBlock;
    spares_ = locals_ + program_.locals * kBlock;
    table_ = reinterpret_cast<float*>(memory + point_bytes + value_bytes);
    immediates_ = table_;
  }

  Place* first_point() { return points_; }
  float* immediate_table() { return table_; }
  // Takes the immediates from `table`, whose rows are `stride` floats apart, instead of immediate_table().
  void read_immediates(const float* table, std::size_t stride) {
    immediates_ = table;
    stride_ = stride;
  }
  const T* result() const { return values_; }
  ChoiceObserver<T>& observer() { return observer_; }
  const TagObserver<T>& tags() const { return tags_; }

  // Runs the program on the block of points at first_point(). The values are at result() afterwards.
  void interpret() {
    Cursor c{0, points_, values_ - kBlock, 0, 1};
    const std::size_t size = program_.size;
    while (c.at != size) {
      const std::uint32_t word = program_.words[c.at];
      ++c.at;
      if constexpr (kFrom == Immediate::PerLane) c.in_table = (c.in_table + 3) & ~std::size_t{3};
      switch (static_cast<Opcode>(word & 0xff)) {
// clang-format off
#define APPLY(Name, apply)                                                                              \
  case Opcode::Name:                                                                                    \
    if constexpr (kInLoop<T>) {                                                                         \
      apply<Name##Op, count_##Name>(c);                                                                 \
    } else {                                                                                            \
      out_of_loop([&]() HWY_ATTR { apply<Name##Op, count_##Name>(c); });                                \
    }                                                                                                   \
    break;
#define OP_Point(Name) APPLY(Name, apply_point)
#define OP_Shape(Name) APPLY(Name, apply_shape)
#define OP_Outline(Name) APPLY(Name, apply_outline)
#define OP_Unary(Name) APPLY(Name, apply_unary)
#define OP_Binary(Name) APPLY(Name, apply_binary)
#define OP_Ternary(Name) APPLY(Name, apply_ternary)
#define OP_Machine(Name)
#define OP(Name, mnemonic, form, ...) OP_##form(Name)
#include "vm/program/opcodes.def"
#include "vm/program/opcodes_end.def"
#undef APPLY
        // clang-format on
        case Opcode::Drop:
          c.point -= kBlock;
          c.affine >>= 1;
          break;
        case Opcode::Tee:
          copy(locals_ + operand_of(word) * kBlock, c.top);
          break;
        case Opcode::Load:
          c.top += kBlock;
          copy(c.top, locals_ + operand_of(word) * kBlock);
          break;
        case Opcode::Tag:
          for (std::size_t i = 0; i < used_; ++i) Traits::tag(c.top[i], tags_.see(operand_of(word), c.point[i]));
          break;
      }
    }
  }

 private:
  // State of the interpreter loop. The Cursor is a local variable and not a member: nothing points to it, so the
  // compiler keeps the Cursor in registers, whereas stores to stack slots could alias members.
  struct Cursor {
    std::size_t at;        // next word
    Place* point;          // top of the point stack
    T* top;                // top of the value stack
    std::size_t in_table;  // row of the next immediate in the table
    // One bit per point on the stack, the top point's lowest: 1 if only affine maps lead to the point, since these
    // preserve convexity. Maintained for Convex values only. Points deeper than 64 count as not affine.
    std::uint64_t affine;
  };

  // Number of immediates per opcode, as compile-time constants.
  enum : int {
#define OP(Name, mnemonic, form, immediates, ...) count_##Name = count_names(immediates),
#include "vm/program/opcodes.def"
#undef OP
  };

  // Local copies of the instruction's immediates as constants, because stores to the stack could alias the originals.
  // take() advances past the immediates. kInProgram: the program has them, even if the table does, too.
  template <int Count>
  struct Immediates {
    C k[Count > 0 ? Count : 1];
    const std::uint32_t* words;
  };
  template <int Count, bool kInProgram = kFrom == Immediate::Program>
  HWY_INLINE Immediates<Count> take(Cursor& c) {
    Immediates<Count> result;
    for (int i = 0; i < Count; ++i) {
      if constexpr (kFrom == Immediate::PerLane) {
        result.k[i] =
            constant_at(immediates_, c.in_table + static_cast<std::size_t>(i), stride_, static_cast<C*>(nullptr));
      } else {
        result.k[i] = immediate(program_, c.at + static_cast<std::size_t>(i), static_cast<C*>(nullptr));
      }
    }
    c.in_table += Count;
    result.words = program_.words + c.at;
    if constexpr (kInProgram) c.at += Count;
    return result;
  }

  template <class Apply>
  static HWY_NOINLINE void out_of_loop(const Apply& apply) {
    apply();
  }

  template <class Op, int Count>
  HWY_INLINE void apply_point(Cursor& c) {
    const auto immediates = take<Count>(c);
    if constexpr (Traits::kConvex) {
      constexpr std::uint64_t kAffine = has(Op::kOpcode, Fact::Affine) ? 1 : 0;
      c.affine = c.affine << 1 | (c.affine & kAffine);
    }
    const Place* from = c.point;
    Place* to = c.point += kBlock;
    for_used([&](std::size_t i) HWY_ATTR { to[i] = Places::template map<Op>(from[i], immediates.k); });
  }
  template <class Op, int Count>
  HWY_INLINE void apply_shape(Cursor& c) {
    if constexpr (kFrom == Immediate::PerLane && Op::kOpcode == Opcode::RoundBox && std::is_same_v<T, Batch>) {
      if (operand_of(program_.words[c.at - 1]) & kPolymorphic) return apply_polymorphic<Count>(c);
    }
    const std::uint32_t modes = operand_of(program_.words[c.at - 1]);
    const bool moved = modes & kFusedTranslate, joined = modes & kFusedMin;
    const auto by = moved ? take<3>(c) : Immediates<3>{};
    constexpr bool kKept = kFrom == Immediate::Program || row_of(opcode_word(Op::kOpcode)).has_integers;
    const auto immediates = take<Count, kKept>(c);
    const Place* from = c.point;
    T* to = joined ? c.top : c.top += kBlock;
    const bool convex = has(Op::kOpcode, Fact::Convex) && c.affine & 1;
    for_used([&](std::size_t i) HWY_ATTR {
      const T value = Traits::lift(
          Places::template shape<Op, Count>(from[i], moved, by.k, immediates.k, immediates.words), convex);
      if (joined) observer_.see(i, to[i], value);
      to[i] = joined ? MinOp::apply(to[i], value, immediates.k) : value;
    });
    if (joined) observer_.next();
  }
  // Applies a shape that differs per lane, as vm/prune/program_template.h lays it out.
  template <int Count>
  HWY_INLINE void apply_polymorphic(Cursor& c) {
    const std::uint32_t modes = operand_of(program_.words[c.at - 1]);
    const bool joined = modes & kFusedMin;
    const Place from = modes & kPlaced ? AffineOp::apply(*c.point, take<count_Affine>(c).k) : *c.point;
    const auto by = take<3>(c);
    const auto immediates = take<Count>(c);
    const T value =
        any_shape(TranslateOp::apply(from, by.k), immediates.k, C::load(immediates_ + c.in_table * stride_));
    if (!joined) c.top += kBlock;
    *c.top = joined ? MinOp::apply(*c.top, value, immediates.k) : value;
  }
  template <class Op, int Count>
  HWY_INLINE void apply_outline(Cursor& c) {
    const Outline<C, Count> outline(program_, c.at, operand_of(program_.words[c.at - 1]));
    c.at += outline.count() * Count;
    const Place* from = c.point;
    T* to = c.top += kBlock;
    for_used([&](std::size_t i) HWY_ATTR { to[i] = Traits::lift(Places::template outline<Op>(from[i], outline)); });
  }
  template <class Op, int Count>
  HWY_INLINE void apply_unary(Cursor& c) {
    const Sources sources = sources_of(program_.words[c.at - 1]);
    Operand a = operand(c, sources.a, sources.local, spares_);
    const auto immediates = take<Count>(c);
    T* to = c.top += kBlock;
    for_used([&](std::size_t i) HWY_ATTR { to[i] = Traits::template apply<Op>(a.next(), immediates.k); });
  }
  template <class Op, int Count>
  HWY_INLINE void apply_binary(Cursor& c) {
    const Sources sources = sources_of(program_.words[c.at - 1]);
    // In this order, because a's constant precedes b's in the code, and b's value is above a's on the stack.
    const bool stack = sources.b == Source::Stack;
    Operand b = stack ? operand(c, sources.b, 0, nullptr) : Operand{};
    Operand a = operand(c, sources.a, sources.local, spares_);
    if (!stack) b = operand(c, sources.b, sources.local, spares_ + kBlock);
    const auto immediates = take<Count>(c);
    T* to = c.top += kBlock;
    for_used([&](std::size_t i) HWY_ATTR {
      const T &x = a.next(), &y = b.next();
      if constexpr (Op::kChoice != Choice::None) observer_.see(i, x, y);
      to[i] = Traits::template apply<Op>(x, y, immediates.k);
    });
    if constexpr (Op::kChoice != Choice::None) observer_.next();
  }

  template <class Op, int Count>
  HWY_INLINE void apply_ternary(Cursor& c) {
    static_assert(Count == 0);
    T* to = c.top -= 2 * kBlock;
    for_used([&](std::size_t i)
                 HWY_ATTR { to[i] = Traits::template apply<Op>(to[i], to[i + kBlock], to[i + 2 * kBlock]); });
  }

  // Iterates over the numbers of an operand.
  struct Operand {
    const T* at;
    std::size_t step;
    HWY_INLINE const T& next() {
      const T* now = at;
      at += step;
      return *now;
    }
  };
  // Fetches an operand from its source. `spare`: slot for a constant, or for a coordinate that must be converted.
  HWY_INLINE Operand operand(Cursor& c, Source source, std::uint32_t local, T* spare) {
    if (source == Source::Stack) {
      c.top -= kBlock;
      return {c.top + kBlock, 1};
    }
    if (source == Source::Local) return {locals_ + local * kBlock, 1};
    if (source == Source::Constant) {
      *spare = Traits::lift(as_value(c.point->x, take<1>(c).k[0]));
      return {spare, 0};
    }
    const auto axis = static_cast<std::size_t>(source) - static_cast<std::size_t>(Source::X);
    if constexpr (std::is_same_v<T, P>) {
      static_assert(sizeof(Place) % sizeof(T) == 0, "a coordinate's neighbours are a whole number of numbers away");
      return {&c.point->x + axis, sizeof(Place) / sizeof(T)};
    } else {
      P Place::*const coordinate = axis == 0 ? &Place::x : axis == 1 ? &Place::y : &Place::z;
      const Place* point = c.point;
      for_used([&](std::size_t i) HWY_ATTR { spare[i] = Traits::lift(point[i].*coordinate); });
      return {spare, 1};
    }
  }
  HWY_INLINE void copy(T* to, const T* from) {
    for_used([&](std::size_t i) HWY_ATTR { to[i] = from[i]; });
  }

  // Calls body(i) for the numbers in use of a slot. A full block of distances, the common case, has a loop of
  // constant length. For wider types such a loop is no faster and doubles the code.
  template <class Body>
  HWY_INLINE void for_used(const Body& body) {
    if (const std::size_t used = used_;
        kAlwaysFull<T> || kBlock == 1 || (std::is_same_v<T, Batch> && used == kBlock)) {
      for (std::size_t i = 0; i < kBlock; ++i) body(i);
    } else {
      for (std::size_t i = 0; i < used; ++i) body(i);
    }
  }

  const Code program_;
  std::size_t used_;
  Place* points_;
  T* values_;
  T* locals_;
  T* spares_;
  float* table_;
  const float* immediates_;  // the table that is read
  std::size_t stride_ = kLanes;
  [[no_unique_address]] ChoiceObserver<T> observer_;
  [[no_unique_address]] TagObserver<T> tags_;
};

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
