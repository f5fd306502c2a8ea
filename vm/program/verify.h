// The verifier: one linear pass that turns an untrusted Program into a VerifiedProgram, which evaluators run
// unchecked.
//
// The verifier proves that
//   every opcode exists and no instruction is cut off;
//   outlines have at least their row's minimum number of groups;
//   both stacks always hold what an instruction needs;
//   the program ends with exactly one value and the caller's point;
//   locals are written before they are read and are below the declared count;
//   float immediates are finite, and the wide constants round to them;
//   integer immediates are within the range that vm/program/opcodes.def gives, sizes within the limits below.
// Programs have no jumps, so every program ends. Tested by: tests/vm/program/verify_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

#include "vm/program/program.h"

namespace fathom::vm {

// Maximum sizes of a program, which bound memory and time before anything is allocated.
struct Limits {
  std::uint32_t words = 16u << 20;
  std::uint32_t stack = 4096;  // of values and of points
  std::uint32_t locals = 65536;
};

struct VerifyError {
  std::uint32_t offset;  // of the opcode word at fault, in words, or the program's size
  std::string reason;
};

// A program as the interpreter runs it: a view of verified words and the stack sizes they need. Valid as long as the
// owner of the words, a VerifiedProgram or a Part that vm/prune/specialise.h made from one.
struct Code {
  const std::uint32_t* words;
  const double* doubles;  // [word]
  std::size_t size;    // words
  std::uint32_t locals, max_values, max_points, choices;
};

// A program that passed the verifier, and the stack heights it reaches.
class VerifiedProgram {
 public:
  operator Code() const {
    return {program_.words.data(),
            program_.doubles.data(),
            program_.words.size(),
            program_.locals,
            max_values_,
            max_points_,
            choices_};
  }
  const Program& program() const { return program_; }
  std::uint32_t max_values() const { return max_values_; }
  std::uint32_t max_points() const { return max_points_; }
  std::uint32_t instructions() const { return instructions_; }
  std::uint32_t choices() const { return choices_; }  // number of instructions with is_choice() (vm/program/opcode.h)
  std::uint32_t cost() const { return cost_; }        // multiply-adds per point, as vm/program/opcodes.def estimates

 private:
  friend std::variant<VerifiedProgram, VerifyError> verify(Program program, const Limits& limits);
  VerifiedProgram() = default;

  Program program_;
  std::uint32_t max_values_ = 0, max_points_ = 0, instructions_ = 0, choices_ = 0, cost_ = 0;
};

[[nodiscard]] std::variant<VerifiedProgram, VerifyError> verify(Program program, const Limits& limits = {});

}  // namespace fathom::vm
