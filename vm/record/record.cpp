#include "vm/record/record.h"

#include <vector>

#include "vm/interpret/interpret-inl.h"
#include "vm/program/check.h"
#include "vm/record/recorded-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
namespace {

template <class Like>
std::vector<Recorded<Like>> parameters(std::size_t first, std::size_t count) {
  std::vector<Recorded<Like>> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(Recorded<Like>::parameter(first + i));
  return result;
}

// The type selects only the coefficients of the elementary functions; an opcode's formula is the same for all types.
using Number = Recorded<Batch>;

Vec3<Number> point_parameter() { return {Number::parameter(0), Number::parameter(1), Number::parameter(2)}; }

std::vector<Ref> results(const Number& value) { return {value.ref}; }
std::vector<Ref> results(const Vec3<Number>& point) { return {point.x.ref, point.y.ref, point.z.ref}; }

std::vector<Ref> run(Opcode opcode, std::span<const std::uint32_t> words) {
  const OpcodeInfo& row = info(opcode);
  const int values = operand_count(row.form);
  const auto operands = static_cast<std::size_t>(values > 0 ? values : 3);  // a point has three coordinates
  const Vec3<Number> p = point_parameter();
  const Number a = p.x, b = p.y, c = p.z;
  const std::vector<Number> immediates = parameters<Batch>(operands, static_cast<std::size_t>(row.immediates));
  const Number* k = immediates.data();
  switch (opcode) {
// clang-format off
#define OP_Point(Name) case Opcode::Name: return results(Name##Op::apply(p, k));
#define OP_Shape(Name) case Opcode::Name: return results(Name##Op::apply(p, k, words.data()));
#define OP_Outline(Name) case Opcode::Name: break;
#define OP_Unary(Name) case Opcode::Name: return results(Name##Op::apply(a, k));
#define OP_Binary(Name) case Opcode::Name: return results(Name##Op::apply(a, b, k));
#define OP_Ternary(Name) case Opcode::Name: return results(Name##Op::apply(a, b, c));
#define OP_Machine(Name) case Opcode::Name: break;
#define OP(Name, mnemonic, form, ...) OP_##form(Name)
#include "vm/program/opcodes.def"
#include "vm/program/opcodes_end.def"
    // clang-format on
  }
  CHECK(false, "an opcode that computes something of a point or of up to three numbers");
}

std::vector<Ref> run_outline(Opcode opcode, std::span<const double> groups) {
  const Vec3<Number> p = point_parameter();
  switch (opcode) {
// clang-format off
#define OUTLINE_Outline(Name, immediates)                                                   \
  case Opcode::Name: {                                                                      \
    constexpr int kSize = count_names(immediates);                                          \
    const Outline<Number, kSize> outline(groups.data(), groups.size() / std::size_t{kSize}); \
    return results(Name##Op::apply(p, outline));                                            \
  }
#define OUTLINE_Point(...)
#define OUTLINE_Shape(...)
#define OUTLINE_Unary(...)
#define OUTLINE_Binary(...)
#define OUTLINE_Ternary(...)
#define OUTLINE_Machine(...)
#define OP(Name, mnemonic, form, immediates, ...) OUTLINE_##form(Name, immediates)
#include "vm/program/opcodes.def"
#undef OP
#undef OUTLINE_Outline
#undef OUTLINE_Point
#undef OUTLINE_Shape
#undef OUTLINE_Unary
#undef OUTLINE_Binary
#undef OUTLINE_Ternary
#undef OUTLINE_Machine
    // clang-format on
    default:
      CHECK(false, "an opcode with groups of immediates");
  }
}

template <class Like>
std::vector<Ref> run_operation(Operation operation) {
  using N = Recorded<Like>;
  const N a = N::parameter(0), b = N::parameter(1), c = N::parameter(2);
  switch (operation) {
    case Operation::Square:
      return {(a * a).ref};
    case Operation::Length2:
      return {sqrt(a * a + b * b).ref};
    case Operation::Length3:
      return {sqrt(a * a + b * b + c * c).ref};
// `function<N>` runs the kernel; `function` without <N> would record a call instead.
// clang-format off
#define UNARY(Name, function) case Operation::Name: return {function<N>(a).ref};
#define BINARY(Name, function) case Operation::Name: return {function<N>(a, b).ref};
    UNARY(Sin, sin) UNARY(Cos, cos) UNARY(Tan, tan) UNARY(Asin, asin) UNARY(Acos, acos) UNARY(Atan, atan)
    UNARY(Exp, exp) UNARY(Log, log) BINARY(Atan2, atan2) BINARY(Pow, pow)
#undef UNARY
#undef BINARY
          // clang-format on
          default : CHECK(false, "an operation that is made of others");
  }
}

}  // namespace

RecordedFunction record_function(Opcode opcode, std::span<const std::uint32_t> words) {
  RecordedFunction function;
  const Recording recording(function);
  function.results = run(opcode, words);
  return function;
}
RecordedFunction record_function(Opcode opcode, std::span<const double> groups) {
  RecordedFunction function;
  const Recording recording(function);
  function.results = run_outline(opcode, groups);
  return function;
}
RecordedFunction record_function(Operation operation, bool doubles) {
  RecordedFunction function;
  const Recording recording(function);
  function.results = doubles ? run_operation<Real>(operation) : run_operation<Batch>(operation);
  return function;
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace fathom::vm {

RecordedFunction record(Opcode opcode, std::span<const std::uint32_t> immediates) {
  return HWY_NAMESPACE::record_function(opcode, immediates);
}

RecordedFunction record_outline(Opcode opcode, std::span<const double> groups) {
  return HWY_NAMESPACE::record_function(opcode, groups);
}

RecordedFunction record(Operation operation, bool doubles) {
  return HWY_NAMESPACE::record_function(operation, doubles);
}

}  // namespace fathom::vm
