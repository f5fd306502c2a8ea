// Combinators that blend, and those that they are without it.
#pragma once

#include "compiler/graph/graph.h"

namespace fathom::compiler {

inline bool is_blend(Kind kind) { return kind >= Kind::SmoothUnion && kind <= Kind::StairsSubtraction; }

// Without the blend: what a union holds it holds too, and an intersection or cut never more.
inline Kind hard(Kind blend) {
  switch (blend) {
    case Kind::SmoothUnion:
    case Kind::ChamferUnion:
    case Kind::RoundUnion:
    case Kind::StairsUnion:
      return Kind::Union;
    case Kind::SmoothIntersection:
    case Kind::ChamferIntersection:
    case Kind::RoundIntersection:
    case Kind::StairsIntersection:
      return Kind::Intersection;
    default:
      return Kind::Subtraction;
  }
}

}  // namespace fathom::compiler
