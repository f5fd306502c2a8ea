// Records whole programs: runs the interpreter once on names instead of numbers.
// Tested by: tests/vm/native/native_program_test.cpp
#pragma once

#include "vm/program/verify.h"
#include "vm/record/recorded_function.h"

namespace fathom::vm {

// Results of a recorded program.
enum class RecordedResults {
  Distance,
  DistanceAndConvexity,  // and the convexity radius (vm/number/convexity-inl.h)
  DistanceOfRow,         // distance of a template (vm/prune/program_template.h); its constants are parameters, too
  Surface,  // distance, gradient x, y, z, convexity radius, surface: its number, or below 0 if no tag gave one
};

// Records the f32 evaluation of `program`. The parameters are x, y and z, and of a template the constants of
// a row; other immediates are numbers of the function. A loop is recorded with all its passes.
RecordedFunction record_program(const Code& program, RecordedResults results);

}  // namespace fathom::vm
