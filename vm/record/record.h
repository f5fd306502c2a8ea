// The formulas of the opcodes, written down by running each opcode's one meaning on names instead of numbers
// (vm/record/recorded-inl.h). Tested by: tests/vm/record/record_test.cpp
#pragma once

#include <cstdint>
#include <span>

#include "vm/program/opcode.h"
#include "vm/record/recorded_function.h"

namespace fathom::vm {

// What any opcode but a Machine's or an Outline's computes. Its parameters are the coordinates of the point x, y, z
// (of a Point or a Shape) or the operands a, and b of a Binary; then the row's immediates, in order. `immediates` are
// their words: of them the integers shape the function and are no parameters in it; of a row without any none are
// needed.
RecordedFunction record(Opcode opcode, std::span<const std::uint32_t> immediates);

// What an Outline row computes of these groups, one after the other. Its parameters are x, y and z: the groups decide
// which formula it is.
RecordedFunction record_outline(Opcode opcode, std::span<const double> groups);

// What an operation computes that is made of others, such as a sine: for float, or `wide` for double, which take
// other coefficients. Its parameters are the operands.
RecordedFunction record(Operation operation, bool wide);

}  // namespace fathom::vm
