// A function as the list of operations that make it: an opcode's meaning, run once on names instead of numbers.
// vm/record/record.h makes them, compiler/emit/ prints them. Tested by: tests/vm/record/record_test.cpp
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

// How tightly a text holds together, loosest first.
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
    Statement,  // what statement `index` gives
    Number,     // `number`
    Parameter,  // of the function, number `index`
    Carried,    // variable `index` of the loop
  };
  Kind kind = Kind::Number;
  std::uint32_t index = 0;
  double number = 0;

  bool operator==(const Ref&) const = default;
};

struct Statement {
  Operation operation;
  std::array<Ref, 3> operands;  // as many as the operation has

  std::size_t count() const { return info(operation).operands; }
};

// Statements [begin, end) are run up to `count` times; their Any is where the loop ends early.
struct Loop {
  // A variable that is `initial` before the loop and becomes `next` at the end of each pass.
  struct Carried {
    Ref initial, next;
  };
  std::size_t begin, end, count;
  std::vector<Carried> carried;
};

struct RecordedFunction {
  std::vector<Statement> statements;  // in order; operands refer to earlier ones
  std::vector<Ref> results;           // one number, or the three coordinates of a point
  std::optional<Loop> loop;           // none as recorded; see reroll()
};

// The same function with its loop found again. A recording runs a loop `while (any(mask))` to its last pass and so
// holds every pass, one after the other; where they are alike this keeps one and says how often it runs. A function
// without such a loop, or whose passes differ, comes back as it was: it is right as it stands, for what a mask
// excludes keeps its value.
RecordedFunction reroll(RecordedFunction function);

}  // namespace fathom::vm
