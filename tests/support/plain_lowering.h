// Programs for the tests of the machine, without the compiler: plain_lowering() writes a graph out as it stands,
// without optimisation. Shared nodes become locals.
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "vm/program/verify.h"

namespace fathom::test {

// Returns the verified program. Aborts with the verifier's reason when the verifier refuses it.
vm::VerifiedProgram verified(vm::Program program);

// Lowers a scene. Tags carry the surface numbers of Paint nodes. A graph without Paint has no tags.
vm::VerifiedProgram plain_lowering(const compiler::Scene& scene);

// Returns the program of one primitive.
vm::VerifiedProgram primitive_program(compiler::Kind kind, const std::vector<double>& params);

}  // namespace fathom::test
