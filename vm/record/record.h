// Records the formulas of opcodes: runs each opcode's definition on names instead of numbers
// (vm/record/recorded-inl.h). Tested by: tests/vm/record/record_test.cpp
#pragma once

#include <cstdint>
#include <span>

#include "vm/program/opcode.h"
#include "vm/record/recorded_function.h"

namespace fathom::vm {

// Records any opcode except Machine and Outline rows. The function's parameters are the coordinates x, y, z (Point
// and Shape) or the operands a, b, c (Unary to Ternary), then the row's immediates, in order. `immediates` are the
// words of these. Integer immediates determine the function's statements and are not read as parameters. A row
// without integer immediates needs no words.
RecordedFunction record(Opcode opcode, std::span<const std::uint32_t> immediates);

// Records an Outline row for the concatenated `groups`. The parameters are x, y and z; the groups are constants of
// the recorded formula.
RecordedFunction record_outline(Opcode opcode, std::span<const double> groups);

// Records an operation that consists of other operations, such as a sine, for float or for double (`wide`), whose
// coefficients differ. The parameters are the operands.
RecordedFunction record(Operation operation, bool doubles);

}  // namespace fathom::vm
