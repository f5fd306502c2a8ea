// Recorded: a number type that holds a name instead of a value. Every operation on a Recorded is appended to the
// function being recorded and returns the name of its result. So running an opcode's definition records its formula.
//
// Like is the type whose elementary functions are recorded, Batch or Real, which differ in their coefficients.
// any(mask) returns true, so a loop is recorded up to its last pass (vm/record/recorded_function.h).
#pragma once

#include <array>

#include "vm/number/elementary-inl.h"
#include "vm/number/number-inl.h"
#include "vm/record/recorded_function.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Sets the function that operations are appended to during the Recording's lifetime. The function is thread-local,
// because a Recorded holds only a name and no reference to its function.
class Recording {
 public:
  explicit Recording(RecordedFunction& into) : outer_(current_) { current_ = &into; }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording() { current_ = outer_; }

  template <class... Refs>
  static Ref append(Operation operation, const Refs&... operands) {
    current_->statements.push_back({operation, {operands...}});
    return {Ref::Kind::Statement, static_cast<std::uint32_t>(current_->statements.size() - 1)};
  }

 private:
  inline static thread_local RecordedFunction* current_ = nullptr;
  RecordedFunction* outer_;
};

template <class Like>
struct Recorded {
  using Constant = Recorded;
  Ref ref;

  static Recorded broadcast(double value) { return {{Ref::Kind::Number, 0, value}}; }
  static Recorded parameter(std::size_t index) { return {{Ref::Kind::Parameter, static_cast<std::uint32_t>(index)}}; }
};

struct RecordedMask {
  Ref ref;
};

// An immediate that differs per lane is a parameter after the coordinates.
template <class Like>
Recorded<Like> constant_at(const float*, std::size_t row, std::size_t, Recorded<Like>*) {
  return Recorded<Like>::parameter(3 + row);
}

template <class Like>
struct Precision<Recorded<Like>> : Precision<Like> {};

// clang-format off
#define RECORD_UNARY(function, Name)                                                                                  \
  template <class Like>                                                                                               \
  Recorded<Like> function(const Recorded<Like>& a) {                                                                  \
    return {Recording::append(Operation::Name, a.ref)};                                                               \
  }
#define RECORD_BINARY(function, Name)                                                                                 \
  template <class Like>                                                                                               \
  Recorded<Like> function(const Recorded<Like>& a, const Recorded<Like>& b) {                                         \
    return {Recording::append(Operation::Name, a.ref, b.ref)};                                                        \
  }
RECORD_BINARY(operator+, Add)
RECORD_BINARY(operator-, Subtract)
RECORD_BINARY(operator*, Multiply)
RECORD_BINARY(operator/, Divide)
RECORD_UNARY(operator-, Negate)
RECORD_BINARY(min, Min)
RECORD_BINARY(max, Max)
RECORD_UNARY(abs, Abs)
RECORD_UNARY(sqrt, Sqrt)
RECORD_UNARY(floor, Floor)
RECORD_UNARY(ceil, Ceil)
RECORD_UNARY(round_nearest, Nearest)
RECORD_UNARY(power_of_two, PowerOfTwo)
// Functions recorded as calls; vm/record/record.cpp records their bodies from their own definitions.
RECORD_UNARY(sqr, Square)
RECORD_BINARY(length, Length2)
RECORD_UNARY(sin, Sin)
RECORD_UNARY(cos, Cos)
RECORD_UNARY(tan, Tan)
RECORD_UNARY(asin, Asin)
RECORD_UNARY(acos, Acos)
RECORD_UNARY(atan, Atan)
RECORD_BINARY(atan2, Atan2)
RECORD_UNARY(exp, Exp)
RECORD_UNARY(log, Log)
RECORD_BINARY(pow, Pow)
#undef RECORD_UNARY
#undef RECORD_BINARY
// clang-format on

template <class Like>
Recorded<Like> length(const Recorded<Like>& x, const Recorded<Like>& y, const Recorded<Like>& z) {
  return {Recording::append(Operation::Length3, x.ref, y.ref, z.ref)};
}
template <class Like>
RecordedMask operator<(const Recorded<Like>& a, const Recorded<Like>& b) {
  return {Recording::append(Operation::Less, a.ref, b.ref)};
}
template <class Like>
RecordedMask operator>(const Recorded<Like>& a, const Recorded<Like>& b) {
  return b < a;
}
template <class Like>
RecordedMask is_nan(const Recorded<Like>& a) {
  return {Recording::append(Operation::IsNan, a.ref)};
}
inline bool any(const RecordedMask& mask) {
  Recording::append(Operation::Any, mask.ref);
  return true;
}
template <class Like>
Recorded<Like> select(const RecordedMask& mask, const Recorded<Like>& yes, const Recorded<Like>& no) {
  return {Recording::append(Operation::Select, mask.ref, yes.ref, no.ref)};
}
template <class Like>
Scaled<Recorded<Like>> split_power_of_two(const Recorded<Like>& x) {
  return {{Recording::append(Operation::Mantissa, x.ref)}, {Recording::append(Operation::Exponent, x.ref)}};
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
