#include "compiler/passes/passes.h"

namespace fathom::compiler {

std::span<const Pass> passes() {
  static constexpr Pass kPasses[] = {
      {"level", level, Pass::Leaves::Sign},
      {"unpaint", unpaint},
      {"fold", fold},
      {"arithmetic", arithmetic},
      {"affine", affine},
      {"flatten", flatten},
      {"share", share},
      {"cull", cull, Pass::Leaves::Sign},
  };
  return kPasses;
}

}  // namespace fathom::compiler
