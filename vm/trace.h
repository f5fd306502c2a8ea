// A program run at one point with its stacks shown after every instruction, as the machine in f32 has them.
//
// The machine itself keeps no trace: the program is run once for each instruction, up to there. So this is for
// listings, not for speed: the work grows with the square of the length.
// Tested by: tests/vm/trace_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "vm/verify.h"

namespace fathom::vm {

// After an instruction; the deepest first.
struct TraceStep {
  std::size_t offset;             // of its opcode word
  std::vector<glm::vec3> points;  // the caller's is the first
  std::vector<float> values;
};

void trace(const Code& program, glm::dvec3 point, const std::function<void(const TraceStep&)>& each);

}  // namespace fathom::vm
