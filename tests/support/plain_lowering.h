// Programs for the machine's tests without the compiler: a graph written out as it stands, nothing optimised. Shared
// nodes become locals. And the ways to get a verified program or die trying.
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "vm/program/verify.h"

namespace fathom::test {

// Aborts with the verifier's reason when it refuses.
vm::VerifiedProgram verified(vm::Program program);

// Tags number the surfaces as Paint does; a graph without Paint has no tags.
vm::VerifiedProgram plain_lowering(const compiler::Scene& scene);

// One primitive.
vm::VerifiedProgram primitive_program(compiler::Kind kind, const std::vector<double>& params);

}  // namespace fathom::test
