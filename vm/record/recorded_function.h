// A function as a list of operations: an opcode's definition, run once on names instead of numbers.
// vm/record/record.h makes such functions, compiler/emit/ prints them. Tested by: tests/vm/record/record_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace fathom::vm {

enum class Operation : std::uint8_t {
#define OPERATION(Name, ...) Name,
#include "vm/record/operations.def"
#undef OPERATION
};

// Operator precedence of a text, loosest first.
enum class Binding : std::uint8_t { Comparison, Sum, Product, Sign, Call };
enum class ResultType : std::uint8_t { Number, Mask };

struct OperationInfo {
  std::string_view name;
  std::size_t operands;
  ResultType result;
  Binding binding;
  std::string_view cpp, glsl;
};
const OperationInfo& info(Operation operation);

// An operand or a result.
struct Ref {
  enum class Kind : std::uint8_t {
    Statement,  // result of statement `index`
    Number,     // the constant `number`
    Parameter,  // parameter `index` of the function
    Carried,    // variable `index` of the loop
  };
  Kind kind = Kind::Number;
  std::uint32_t index = 0;
  double number = 0;

  bool operator==(const Ref&) const = default;
};

struct Statement {
  Operation operation;
  std::array<Ref, 3> operands;  // [0, count())

  std::size_t count() const { return info(operation).operands; }
};

// Runs statements [begin, end) up to `count` times; the Any statement among them ends the loop early.
struct Loop {
  // Variable that is `initial` before the loop and becomes `next` at the end of each pass.
  struct Carried {
    Ref initial, next;
  };
  std::size_t begin, end, count;
  std::vector<Carried> carried;
};

struct RecordedFunction {
  std::vector<Statement> statements;  // in order; operands refer to earlier statements
  std::vector<Ref> results;           // one number, or the three coordinates of a point
  std::optional<Loop> loop;           // empty after recording; see reroll()
};

// Returns `function` with its loop restored. A recording runs a loop `while (any(mask))` to its last pass, so it
// holds every pass in order. If the passes are alike, reroll() keeps one pass and the number of passes. A function
// without a loop, or with differing passes, is returned unchanged. An unrolled loop is still correct, because lanes
// excluded by a mask keep their values.
RecordedFunction reroll(RecordedFunction function);

}  // namespace fathom::vm
