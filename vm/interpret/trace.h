// Runs a program at one point in f32 and reports both stacks after every instruction.
//
// The interpreter keeps no trace. Instead, trace() runs the program once per instruction, up to that instruction. So
// the work grows with the square of the program's length: use traces for listings only.
// Tested by: tests/vm/interpret/trace_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "vm/program/verify.h"

namespace fathom::vm {

// Stacks after an instruction, deepest entry first.
struct TraceStep {
  std::size_t offset;             // of the instruction's opcode word
  std::vector<glm::vec3> points;  // the first is the caller's
  std::vector<float> values;
};

void trace(const Code& program, glm::dvec3 point, const std::function<void(const TraceStep&)>& each);

// Returns the offset of the opcode word of an instruction before which all entries of the stacks are finite in f32,
// and after which some are infinite or NaN. Returns nothing if the program's value at the point is finite.
std::optional<std::size_t> first_not_finite(const Code& program, glm::dvec3 point);

}  // namespace fathom::vm
