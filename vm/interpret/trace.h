// A program run at one point with its stacks shown after every instruction, as the machine in f32 has them.
//
// The machine itself keeps no trace: the program is run once for each instruction, up to there. So this is for
// listings, not for speed: the work grows with the square of the length.
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

// After an instruction; the deepest first.
struct TraceStep {
  std::size_t offset;             // of its opcode word
  std::vector<glm::vec3> points;  // the caller's is the first
  std::vector<float> values;
};

void trace(const Code& program, glm::dvec3 point, const std::function<void(const TraceStep&)>& each);

// Where the program's value at the point, in f32, is not a finite number: an instruction before which all on the
// stacks was finite, and after it no longer; the offset of its opcode word. Nothing where the value is finite.
std::optional<std::size_t> first_not_finite(const Code& program, glm::dvec3 point);

}  // namespace fathom::vm
