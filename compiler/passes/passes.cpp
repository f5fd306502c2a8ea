#include "compiler/passes/passes.h"

namespace fathom::compiler {

std::span<const Pass> passes() {
  static constexpr Pass kPasses[] = {
      {"normalise", normalise, Pass::Leaves::Sign},
      {"strip", strip},
      {"fold", fold},
      {"arithmetic", arithmetic},
      {"affine", affine},
      {"flatten", flatten},
      {"canonicalise", canonicalise},
      {"cull", cull, Pass::Leaves::Sign},
  };
  return kPasses;
}

}  // namespace fathom::compiler
